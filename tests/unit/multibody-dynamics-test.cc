// Forward dynamics, inverse dynamics and mass matrix of multibodies against one another, against
// closed forms and against conservation laws.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "multibody/accounts.h"
#include "multibody/forward-dynamics.h"
#include "multibody/inverse-dynamics.h"
#include "multibody/jacobian.h"
#include "multibody/joint-forces.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;
Eigen::MatrixXd mass_matrix_of(const Tree& tree, const Kinematics& k) {
  InverseDynamics work(tree);
  Eigen::MatrixXd M(tree.nv(), tree.nv());
  mass_matrix(tree, k, work, Out(M.data(), static_cast<std::size_t>(M.size())));
  return M;
}

void push_links(const Tree& tree, Kinematics& k, Random& random) {
  for (int i = 0; i < tree.link_count(); ++i) {
    add_force(tree, k, i, random_vector(random, 2), random_vector(random, 20));
    add_torque(tree, k, i, random_vector(random, 5));
  }
}

TEST(MultibodyDynamics, forward_and_inverse_dynamics_and_mass_matrix_agree) {
  Random random(1);
  double worst = 0;
  for (int round = 0; round < 300; ++round) {
    const int count = 1 + static_cast<int>(random.below(12));
    const TreeState s(random_links(random, count, false), random, true);
    const Tree& tree = s.tree;
    Kinematics k(tree);
    place(tree, s.q, s.u, s.around, k);
    push_links(tree, k, random);
    const Numbers tau = random_numbers(random, s.u.size(), 10);
    Numbers rate = s.zeros(), back = s.zeros(), bias = s.zeros();
    Articulation a(tree);
    ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
    InverseDynamics work(tree);
    inverse_dynamics(tree, k, rate, work, back);
    inverse_dynamics(tree, k, s.zeros(), work, bias);
    const Eigen::MatrixXd M = mass_matrix_of(tree, k);
    const Column by_matrix = M.llt().solve(column(tau) - column(bias));
    if (s.u.empty()) continue;
    // rounding of the solution grows with the condition, that of the torques does not
    const double scale = column(tau).norm() + column(bias).norm();
    EXPECT_LT((column(back) - column(tau)).norm(), 1e-12 * scale) << "round " << round;
    EXPECT_LT((M * (by_matrix - column(rate))).norm(), 1e-12 * scale) << "round " << round;
    worst = std::max(worst, (by_matrix - column(rate)).norm() / column(rate).norm());
  }
  EXPECT_LT(worst, 1e-12);
}

// Along its axes a joint passes on what drives it; what passes to links of the base is all that
// acts and accelerates.
TEST(MultibodyDynamics, joints_pass_on_the_torques_that_drive_them) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const int count = 1 + static_cast<int>(random.below(12));
    const TreeState s(random_links(random, count, false), random, true);
    const Tree& tree = s.tree;
    Kinematics k(tree);
    place(tree, s.q, s.u, s.around, k);
    std::vector<Force> wrenches;
    for (int i = 0; i < tree.link_count(); ++i) {
      const Vec3 c = link_center_of_mass(tree, k, i);
      const Vec3 force = random_vector(random, 20), torque = random_vector(random, 5);
      add_force(tree, k, i, c, force);
      add_torque(tree, k, i, torque);
      wrenches.push_back({(c - k.origin).cross(force) + torque, force});
    }
    const Numbers tau = random_numbers(random, s.u.size(), 10);
    Numbers rate = s.zeros(), back = s.zeros();
    Articulation a(tree);
    ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
    InverseDynamics work(tree);
    inverse_dynamics(tree, k, rate, work, back);
    const std::vector<Force> through = joint_forces(tree, k, a.acceleration, wrenches);
    double scale = 1;
    for (const Force& f : through) scale = std::max(scale, f.vector().norm());
    for (int i = 0; i < tree.link_count(); ++i) {
      const Link& link = tree.link(i);
      const Force& f = through[static_cast<std::size_t>(i)];
      for (int d = link.u; d < link.u + link.dofs; ++d)
        EXPECT_NEAR(dot(k.axis(d), f), tau[static_cast<std::size_t>(d)], 1e-12 * scale);
      // the first of its node: the node's own force
      if (link.joint == JointKind::weld) continue;
      const Force& whole = work.force[static_cast<std::size_t>(link.node)];
      EXPECT_LT((f - whole).vector().norm(), 1e-12 * scale) << "round " << round;
    }
  }
}

TEST(MultibodyDynamics, a_rod_swings_as_a_pendulum) {
  LinkSpec rod;
  rod.name = "rod";
  rod.joint.axis = Vec3::UnitY();
  rod.mass = 2;
  rod.center_of_mass = {0, 0, -0.5};
  rod.inertia = Vec3(2.0 / 12, 2.0 / 12, 0).asDiagonal();
  const Tree tree({rod});
  BaseMotion around;
  around.gravity = {0, 0, -9.81};
  Kinematics k(tree);
  Articulation a(tree);
  for (double angle : {-2.0, -0.3, 0.0, 0.7, 3.0}) {
    const Numbers q{angle}, u{1.5}, tau{0.25};
    Numbers rate(1);
    place(tree, q, u, around, k);
    ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
    // (m l^2/3) angle'' = tau - m g l/2 sin angle
    EXPECT_NEAR(rate[0], (0.25 - 2 * 9.81 * 0.5 * std::sin(angle)) / (2.0 / 3), 1e-13);
    EXPECT_NEAR(kinetic_energy(tree, k), 0.5 * 2.0 / 3 * 1.5 * 1.5, 1e-14);
    EXPECT_NEAR(gravity_energy(tree, k, around.gravity), -2 * 9.81 * 0.5 * std::cos(angle), 1e-13);
  }
}

TEST(MultibodyDynamics, two_points_on_strings_are_the_double_pendulum) {
  // Lagrange's equations of points m1, m2 on massless rods l1, l2, angles from the vertical
  const double m1 = 1.3, m2 = 0.7, l1 = 0.8, l2 = 1.1, g = 9.81;
  LinkSpec upper, lower;
  upper.name = "upper";
  upper.joint.axis = -Vec3::UnitY();
  upper.mass = m1;
  upper.center_of_mass = {0, 0, -l1};
  lower = upper;
  lower.name = "lower";
  lower.parent = "upper";
  lower.joint.placement.p = {0, 0, -l1};
  lower.mass = m2;
  lower.center_of_mass = {0, 0, -l2};
  const Tree tree({upper, lower});
  BaseMotion around;
  around.gravity = {0, 0, -g};
  const double t1 = 0.4, t2 = -1.1, w1 = 2, w2 = -3;
  const Numbers q{t1, t2 - t1}, u{w1, w2 - w1}, tau{0, 0};
  Kinematics k(tree);
  Articulation a(tree);
  Numbers rate(2);
  place(tree, q, u, around, k);
  ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
  const double d = t1 - t2, D = m1 + m2 * std::sin(d) * std::sin(d);
  const double a1 = (-m2 * std::sin(d) * (l1 * w1 * w1 * std::cos(d) + l2 * w2 * w2) -
                     (m1 + m2) * g * std::sin(t1) + m2 * g * std::cos(d) * std::sin(t2)) /
                    (l1 * D);
  const double a2 = (std::sin(d) * ((m1 + m2) * l1 * w1 * w1 + m2 * l2 * w2 * w2 * std::cos(d)) +
                     (m1 + m2) * g * (std::cos(d) * std::sin(t1) - std::sin(t2))) /
                    (l2 * D);
  EXPECT_NEAR(rate[0], a1, 1e-12);
  EXPECT_NEAR(rate[0] + rate[1], a2, 1e-12);
}

// Calls f with the tree placed a time s further on a curve whose first derivatives are right.
template <class Function>
auto along(const TreeState& state, const Numbers& rate, Kinematics& k, Function f) {
  return difference_of_order_8(0.002, [&](double s) {
    Numbers q(state.q.size());
    displace(state.tree, state.q, numbers(s * column(state.u)), q);
    place(state.tree, q, numbers(column(state.u) + s * column(rate)), state.around, k);
    return f(q);
  });
}

TEST(MultibodyDynamics, energy_changes_by_the_power_of_what_acts) {
  Random random(2);
  for (int round = 0; round < 60; ++round) {
    const TreeState s(random_links(random, 7, false), random, false);
    const Tree& tree = s.tree;
    Kinematics k(tree);
    place(tree, s.q, s.u, s.around, k);
    const int pushed = static_cast<int>(random.below(7));
    const Vec3 force = random_vector(random, 20), torque = random_vector(random, 5);
    const LinkTwist twist = link_twist(tree, k, pushed);
    add_force(tree, k, pushed, link_frame(tree, k, pushed).p, force);
    add_torque(tree, k, pushed, torque);
    const Numbers tau = random_numbers(random, s.u.size(), 10);
    Numbers rate = s.zeros();
    Articulation a(tree);
    ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
    const double power = column(tau).dot(column(s.u)) + force.dot(twist.v) + torque.dot(twist.w);
    const double change = along(s, rate, k, [&](const Numbers&) {
      return kinetic_energy(tree, k) + gravity_energy(tree, k, s.around.gravity);
    });
    EXPECT_NEAR(change, power, 1e-10 * (100 + std::abs(power)));
  }
}

TEST(MultibodyDynamics, springs_take_what_their_energy_gains_and_damping_only_takes) {
  Random random(3);
  for (int round = 0; round < 40; ++round) {
    std::vector<LinkSpec> links = random_links(random, 6, true);
    for (LinkSpec& link : links)
      for (AxisSpec& axis : link.joint.axes) axis.damping = axis.friction = 0;
    const TreeState s(links, random, false);
    Kinematics k(s.tree);
    Numbers tau = s.zeros();
    joint_torques(s.tree, s.q, s.u, {}, tau);
    const double change =
        along(s, s.zeros(), k, [&](const Numbers& q) { return spring_energy(s.tree, q); });
    EXPECT_NEAR(change, -column(tau).dot(column(s.u)), 1e-10 * 100);
  }
  for (int round = 0; round < 40; ++round) {
    std::vector<LinkSpec> links = random_links(random, 6, true);
    for (LinkSpec& link : links)
      for (AxisSpec& axis : link.joint.axes) axis.stiffness = 0;
    const TreeState s(links, random, false);
    Numbers tau = s.zeros();
    joint_torques(s.tree, s.q, s.u, {}, tau);
    if (s.tree.axis_count() == 0) continue;
    EXPECT_LT(column(tau).dot(column(s.u)), 0);
  }
}

TEST(MultibodyDynamics, momentum_of_what_floats_changes_by_outer_forces_alone) {
  Random random(4);
  for (int round = 0; round < 40; ++round) {
    std::vector<LinkSpec> links = random_links(random, 7, false);
    links[0].joint.kind = JointKind::free;
    const TreeState s(links, random, false);
    const Tree& tree = s.tree;
    Kinematics k(tree);
    place(tree, s.q, s.u, s.around, k);
    Numbers tau = random_numbers(random, s.u.size(), 10), rate = s.zeros();
    for (std::size_t i = 0; i < 6; ++i) tau[i] = 0;
    Articulation a(tree);
    ASSERT_TRUE(forward_dynamics(tree, k, tau, a, rate));
    const Vec3 weight = tree.mass() * s.around.gravity, center = center_of_mass(tree, k);
    const Vec3 point(1, 2, 3);
    const Vec3 p = along(s, rate, k, [&](const Numbers&) { return momentum(tree, k); });
    const Vec3 l =
        along(s, rate, k, [&](const Numbers&) { return angular_momentum(tree, k, point); });
    EXPECT_LT((p - weight).norm(), 1e-10 * weight.norm() + 1e-9);
    EXPECT_LT((l - (center - point).cross(weight)).norm(), 1e-8);
    const Vec3 moved = along(s, rate, k, [&](const Numbers&) { return center_of_mass(tree, k); });
    place(tree, s.q, s.u, s.around, k);
    EXPECT_LT((moved * tree.mass() - momentum(tree, k)).norm(), 1e-10);
  }
}

TEST(MultibodyDynamics, links_move_as_their_frames_do_and_as_the_jacobian_says) {
  Random random(5);
  for (int round = 0; round < 40; ++round) {
    const TreeState s(random_links(random, 8, false), random, false);
    const Tree& tree = s.tree;
    Kinematics k(tree), moved(tree);
    place(tree, s.q, s.u, s.around, k);
    for (int i = 0; i < tree.link_count(); ++i) {
      const Frame X = link_frame(tree, k, i);
      const LinkTwist twist = link_twist(tree, k, i);
      const Vec3 v =
          along(s, s.zeros(), moved, [&](const Numbers&) { return link_frame(tree, moved, i).p; });
      const Mat3 turning =
          along(s, s.zeros(), moved, [&](const Numbers&) { return link_frame(tree, moved, i).R; });
      EXPECT_LT((v - twist.v).norm(), 1e-10);
      EXPECT_LT((turning * X.R.transpose() - cross_matrix(twist.w)).norm(), 1e-10);
      Eigen::MatrixXd J(6, tree.nv());
      link_jacobian(tree, k, i, Out(J.data(), static_cast<std::size_t>(J.size())));
      const Vec6 by_jacobian = J * column(s.u);
      EXPECT_LT((by_jacobian - (Vec6() << twist.v, twist.w).finished()).norm(), 1e-12);
    }
  }
}

TEST(MultibodyDynamics, a_moving_base_is_as_a_free_link_that_moves_so) {
  Random random(6);
  for (int round = 0; round < 40; ++round) {
    std::vector<LinkSpec> links = random_links(random, 6, false);
    if (links[0].joint.kind == JointKind::free) links[0].joint.kind = JointKind::universal;
    const TreeState s(links, random, true);
    std::vector<LinkSpec> floating = links;
    for (LinkSpec& link : floating)
      if (link.parent.empty()) link.parent = "carrier";
    LinkSpec carrier = random_link(random, JointKind::free, 99, -1, false);
    carrier.name = "carrier";
    floating.insert(floating.begin(), carrier);
    const Tree carried(floating);
    Numbers q(7), u(6), rate(6);
    set_vector(&q[0], s.around.base.p);
    set_quaternion(&q[3], Quat(s.around.base.R));
    set_vector(&u[0], s.around.v), set_vector(&u[3], s.around.w);
    set_vector(&rate[0], s.around.a), set_vector(&rate[3], s.around.alpha);
    const Numbers own_rate = random_numbers(random, s.u.size(), 5);
    q.insert(q.end(), s.q.begin(), s.q.end());
    u.insert(u.end(), s.u.begin(), s.u.end());
    rate.insert(rate.end(), own_rate.begin(), own_rate.end());
    Kinematics k(s.tree), kc(carried);
    place(s.tree, s.q, s.u, s.around, k);
    place(carried, q, u, s.around, kc);
    InverseDynamics work(s.tree), work_c(carried);
    Numbers tau(s.u.size()), tau_c(u.size());
    inverse_dynamics(s.tree, k, own_rate, work, tau);
    inverse_dynamics(carried, kc, rate, work_c, tau_c);
    for (std::size_t i = 0; i < tau.size(); ++i) EXPECT_NEAR(tau[i], tau_c[i + 6], 1e-11);
    for (int i = 0; i < s.tree.link_count(); ++i) {
      const LinkTwist twist = link_twist(s.tree, k, i), same = link_twist(carried, kc, i + 1);
      EXPECT_LT((twist.v - same.v).norm() + (twist.w - same.w).norm(), 1e-12);
    }
  }
}

TEST(MultibodyDynamics, nothing_depends_on_the_point_all_is_about) {
  Random random(7);
  const TreeState s(random_links(random, 9, false), random, true);
  Kinematics k(s.tree);
  Articulation a(s.tree);
  Numbers here = s.zeros(), there = s.zeros();
  place(s.tree, s.q, s.u, s.around, k);
  ASSERT_TRUE(forward_dynamics(s.tree, k, s.zeros(), a, here));
  place(s.tree, s.q, s.u, s.around, Vec3(5, -3, 4), k);
  ASSERT_TRUE(forward_dynamics(s.tree, k, s.zeros(), a, there));
  EXPECT_LT((column(here) - column(there)).norm(), 1e-11 * column(here).norm());
}

TEST(MultibodyDynamics, a_stretched_point_on_a_massless_rod_is_reported_singular) {
  // two parallel hinges, a point at the end: singular where the rods are in line
  LinkSpec first, second;
  first.name = "first";
  second.name = "second";
  second.parent = "first";
  second.joint.placement.p = {1, 0, 0};
  second.mass = 1;
  second.center_of_mass = {1, 0, 0};
  const Tree tree({first, second});
  Kinematics k(tree);
  Articulation a(tree);
  const Numbers u{0, 0}, tau{0, 0};
  Numbers rate(2);
  place(tree, Numbers{0, 1}, u, {}, k);
  EXPECT_TRUE(forward_dynamics(tree, k, tau, a, rate));
  place(tree, Numbers{0, 0}, u, {}, k);
  EXPECT_FALSE(forward_dynamics(tree, k, tau, a, rate));
}

}  // namespace
}  // namespace tw::test
