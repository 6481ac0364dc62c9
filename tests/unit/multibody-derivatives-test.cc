// Derivatives of the equation of motion against differences of order 8.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "multibody/derivatives.h"
#include "multibody/forward-dynamics.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;
using Matrix = Eigen::MatrixXd;

Out all(Matrix& m) { return Out(m.data(), static_cast<std::size_t>(m.size())); }

struct Derivatives {
  Matrix M, Kq, Ku;
  explicit Derivatives(int n) : M(n, n), Kq(n, n), Ku(n, n) {}
};

// The same by differences of f(z, u).
template <class Residual>
Derivatives differences(const TreeState& s, Residual f) {
  const int n = s.tree.nv();
  Derivatives d(n);
  for (int j = 0; j < n; ++j) {
    const auto along_q = [&](double h) -> Column {
      Numbers q(s.q.size());
      displace(s.tree, s.q, numbers(h * Column::Unit(n, j)), q);
      return f(q, s.u);
    };
    const auto along_u = [&](double h) -> Column {
      return f(s.q, numbers(column(s.u) + h * Column::Unit(n, j)));
    };
    d.Kq.col(j) = difference_of_order_8(0.005, along_q);
    d.Ku.col(j) = difference_of_order_8(0.1, along_u);
  }
  return d;
}

void expect_same(const Derivatives& a, const Derivatives& b, double tolerance) {
  const double scale = 1 + b.Kq.cwiseAbs().maxCoeff() + b.Ku.cwiseAbs().maxCoeff();
  EXPECT_LT((a.Kq - b.Kq).cwiseAbs().maxCoeff(), tolerance * scale);
  EXPECT_LT((a.Ku - b.Ku).cwiseAbs().maxCoeff(), tolerance * scale);
}

TEST(MultibodyDerivatives, of_trees_of_all_joints_on_moving_bases) {
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    const TreeState s(random_links(random, 7, false), random, true);
    const Numbers rate = random_numbers(random, s.u.size(), 5);
    Kinematics k(s.tree);
    InverseDynamics work(s.tree);
    Linearisation linear(s.tree);
    Derivatives d(s.tree.nv());
    place(s.tree, s.q, s.u, s.around, k);
    linear.clear_wrenches();
    linearise(s.tree, k, rate, linear, all(d.M), all(d.Kq), all(d.Ku));
    Matrix M(s.tree.nv(), s.tree.nv());
    mass_matrix(s.tree, k, work, all(M));
    EXPECT_LT((M - d.M).norm(), 1e-12 * M.norm());
    const auto residual = [&](const Numbers& q, const Numbers& u) -> Column {
      place(s.tree, q, u, s.around, k);
      Numbers tau = s.zeros();
      inverse_dynamics(s.tree, k, rate, work, tau);
      return -column(tau);
    };
    expect_same(d, differences(s, residual), 1e-11);
  }
}

TEST(MultibodyDerivatives, of_joint_laws_servos_and_stops) {
  Random random(12);
  for (int round = 0; round < 60; ++round) {
    TreeState s(random_links(random, 7, true), random, false);
    const Tree& tree = s.tree;
    // away from 0, where friction turns within 1e-3
    for (double& x : s.u) x += std::copysign(0.1, x);
    std::vector<ServoGains> servos(tree.axes().size());
    for (ServoGains& gains : servos) {
      gains.stiffness = random.real(0, 50);
      gains.damping = random.real(0, 5);
      if (random.below(2) == 0) gains.max_torque = random.real(1, 10);
    }
    Numbers targets(s.q.size()), speeds = random_numbers(random, s.u.size(), 1);
    displace(tree, s.q, random_numbers(random, s.u.size(), 1), targets);
    Inputs inputs;
    inputs.servos = servos;
    inputs.targets = targets;
    inputs.target_velocities = speeds;
    Derivatives d(tree.nv());
    d.Kq.setZero(), d.Ku.setZero();
    add_joint_derivatives(tree, s.q, s.u, inputs, all(d.Kq), all(d.Ku));
    const auto law = [&](const Numbers& q, const Numbers& u) -> Column {
      Numbers tau = s.zeros();
      joint_torques(tree, q, u, inputs, tau);
      return column(tau);
    };
    const int n = tree.nv();
    Derivatives by(n);
    for (int j = 0; j < n; ++j) {
      by.Kq.col(j) = difference_of_order_8(1e-4, [&](double h) -> Column {
        Numbers q(s.q.size());
        displace(tree, s.q, numbers(h * Column::Unit(n, j)), q);
        return law(q, s.u);
      });
      by.Ku.col(j) = difference_of_order_8(1e-4, [&](double h) -> Column {
        return law(s.q, numbers(column(s.u) + h * Column::Unit(n, j)));
      });
    }
    expect_same(d, by, 1e-9);
  }
}

TEST(MultibodyDerivatives, of_friction_about_standstill) {
  LinkSpec wheel;
  wheel.name = "wheel";
  wheel.mass = 1;
  wheel.inertia = Mat3::Identity();
  wheel.joint.axes[0].friction = 2;
  const Tree tree({wheel});
  const double v0 = friction_speed(tree.axes()[0]);
  for (double speed : {0.0, 0.5 * v0, -2 * v0}) {
    Numbers q{0.3}, u{speed}, Kq{0}, Ku{0};
    add_joint_derivatives(tree, q, u, {}, Kq, Ku);
    const double by = difference_of_order_8(1e-2 * v0, [&](double h) {
      Numbers tau(1);
      joint_torques(tree, q, Numbers{speed + h}, {}, tau);
      return tau[0];
    });
    EXPECT_NEAR(Ku[0], by, 1e-6 * std::abs(by));
    EXPECT_EQ(Kq[0], 0);
  }
}

// Of mass 1 kg and moments of 1 kg m^2.
LinkSpec unit_link(JointKind kind) {
  LinkSpec link;
  link.name = "link";
  link.mass = 1;
  link.inertia = Mat3::Identity();
  link.joint.kind = kind;
  return link;
}

// The torques at q1, u1 less those along the tangent at q0, u0, on the way by z.
Numbers off_tangent(const Tree& tree, const JointMotion& from, const JointMotion& to,
                    const Numbers& z, const Inputs& inputs) {
  const std::size_t n = z.size();
  Numbers before(n), after(n), Kq(n * n), Ku(n * n);
  joint_torques(tree, from.q, from.u, inputs, before);
  joint_torques(tree, to.q, to.u, inputs, after);
  add_joint_derivatives(tree, from.q, from.u, inputs, Kq, Ku);
  for (std::size_t i = 0; i < n; ++i) {
    after[i] -= before[i];
    for (std::size_t j = 0; j < n; ++j)
      after[i] -= Kq[i + n * j] * z[j] + Ku[i + n * j] * (to.u[j] - from.u[j]);
  }
  return after;
}

// Where it is faster by then: the torque less that along the tangent at the first velocity.
TEST(MultibodyDerivatives, leave_friction_that_lets_go_unforeseen) {
  Random random(7);
  for (const JointKind kind : {JointKind::revolute, JointKind::spherical}) {
    LinkSpec wheel = unit_link(kind);
    wheel.joint.axes[0].friction = 2;
    const Tree tree({wheel});
    const auto n = static_cast<std::size_t>(tree.nv());
    const Numbers q = kind == JointKind::revolute ? Numbers{0.3} : Numbers{1, 0, 0, 0};
    const double v0 = friction_speed(tree.axes()[0]);
    Numbers from(n), to(n), unforeseen(n);
    for (std::size_t i = 0; i < n; ++i) {
      from[i] = random.real(-v0, v0);
      to[i] = from[i] + random.real(5, 9) * std::copysign(v0, from[i]);
    }
    const Numbers z(n, 0.0);
    EXPECT_TRUE(unforeseen_torques(tree, {q, from}, {q, to}, z, {}, unforeseen));
    const Numbers expected = off_tangent(tree, {q, from}, {q, to}, z, {});
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(unforeseen[i], expected[i], 1e-12);
    EXPECT_FALSE(unforeseen_torques(tree, {q, to}, {q, from}, z, {}, unforeseen));
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(unforeseen[i], 0);
  }
}

TEST(MultibodyDerivatives, friction_is_in_doubt_where_errors_are_faster_than_the_joint) {
  LinkSpec wheel = unit_link(JointKind::spherical);
  wheel.joint.axes[0].friction = 2;
  const Tree tree({wheel});
  const double v0 = friction_speed(tree.axes()[0]);
  const Numbers error{0, 3 * v0, 4 * v0};
  EXPECT_NEAR(friction_doubt(tree, Numbers{0, 0, 0}, error), 5, 1e-12);
  EXPECT_NEAR(friction_doubt(tree, Numbers{20 * v0, 0, 0}, error), 0.25, 1e-12);
  wheel.joint.axes[0].friction = 0;
  EXPECT_EQ(friction_doubt(Tree({wheel}), Numbers{0, 0, 0}, error), 0);
}

// What is off the tangent where a stop opens, or a servo comes to its greatest torque; nothing
// where they grip more than they did.
TEST(MultibodyDerivatives, what_lets_go_is_off_its_tangent) {
  for (const JointKind kind : {JointKind::revolute, JointKind::spherical})
    for (const bool stops : {true, false}) {
      LinkSpec arm = unit_link(kind);
      arm.joint.axes[0].upper = 0.5;
      const Tree tree({arm});
      const auto n = static_cast<std::size_t>(tree.nv());
      const Axis& axis = tree.axes()[0];
      const auto turned = [&](double angle) {
        if (n == 1) return Numbers{angle};
        Numbers q(4);
        set_quaternion(q.data(), rotation_by(Vec3(0, 0, angle)));
        return q;
      };
      const auto turning = [&](double rate) {
        return n == 1 ? Numbers{rate} : Numbers{0, 0, rate};
      };
      const std::vector<Stop> at_stop{Stop::upper};
      const std::vector<ServoGains> servo{{100, 5, 3}};
      const Numbers target = turned(0.5);
      Inputs inputs;
      if (stops)
        inputs.stops = at_stop;
      else
        inputs.servos = servo, inputs.targets = target;
      // 0.2 mrad beyond; 0.5 mrad before.  A servo is cut from 30 mrad on.
      const double near = stops ? 0.5002 : 0.49, far = stops ? 0.4995 : 0.46;
      const Numbers q0 = turned(near), q1 = turned(far), u0 = turning(-0.1 * stop_speed(axis)),
                    u1 = turning(-0.3 * stop_speed(axis)), z = turning(far - near);
      Numbers unforeseen(n);
      EXPECT_TRUE(unforeseen_torques(tree, {q0, u0}, {q1, u1}, z, inputs, unforeseen));
      const Numbers expected = off_tangent(tree, {q0, u0}, {q1, u1}, z, inputs);
      double most = 0;
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(unforeseen[i], expected[i], 1e-12);
        most = std::max(most, std::abs(unforeseen[i]));
      }
      EXPECT_GT(most, 0.1);
      const Numbers back = turning(near - far);
      EXPECT_FALSE(unforeseen_torques(tree, {q1, u1}, {q0, u0}, back, inputs, unforeseen));
    }
}

TEST(MultibodyDerivatives, a_stop_pushes_out_and_is_smooth_in_contact) {
  LinkSpec arm;
  arm.name = "arm";
  arm.mass = 1;
  arm.inertia = Mat3::Identity();
  arm.joint.axes[0].lower = -1;
  arm.joint.axes[0].upper = 1;
  arm.joint.axes[0].restitution = 0.5;
  arm.joint.axes[0].stop_stiffness = 1e4;
  const Tree tree({arm});
  for (double side : {-1.0, 1.0}) {
    const std::vector<Stop> stops{side < 0 ? Stop::lower : Stop::upper};
    Inputs inputs;
    inputs.stops = stops;
    const auto torque = [&](double q, double u) {
      Numbers tau(1);
      joint_torques(tree, Numbers{q}, Numbers{u}, inputs, tau);
      return tau[0];
    };
    const double q = side * 1.001, u = side * 2e-3;
    const double reach = std::sqrt(1.5), b = 1.5 * 0.5 / (3e-3 * std::sqrt(9.81 / reach));
    EXPECT_NEAR(torque(q, u), -side * 1e4 * 0.001 * (1 + b * 2e-3), 1e-9);
    EXPECT_EQ(torque(side * 0.999, u), 0) << "within the limits";
    EXPECT_EQ(torque(q, -side * 1), 0) << "it never pulls";
    Numbers Kq{0}, Ku{0};
    add_joint_derivatives(tree, Numbers{q}, Numbers{u}, inputs, Kq, Ku);
    EXPECT_NEAR(Kq[0], difference_of_order_8(1e-5, [&](double h) { return torque(q + h, u); }),
                1e-6);
    EXPECT_NEAR(Ku[0], difference_of_order_8(1e-4, [&](double h) { return torque(q, u + h); }),
                1e-6);
  }
}

// A damped spring between points of two links, and the derivative of its wrench about `origin` by
// the motion of one end: f = k (y - x) + c (v_y - v_x) on x.
struct Tie {
  int link[2];
  Vec3 at[2];  // in the links' frames
  double k = 40, c = 3;

  Vec3 point(const Tree& tree, const Kinematics& motion, int side) const {
    return link_frame(tree, motion, link[side]) * at[side];
  }
  Vec3 velocity(const Tree& tree, const Kinematics& motion, int side) const {
    const LinkTwist t = link_twist(tree, motion, link[side]);
    return t.v + t.w.cross(point(tree, motion, side) - link_frame(tree, motion, link[side]).p);
  }
  Vec3 force(const Tree& tree, const Kinematics& m, int side) const {
    return k * (point(tree, m, 1 - side) - point(tree, m, side)) +
           c * (velocity(tree, m, 1 - side) - velocity(tree, m, side));
  }
  void pull(const Tree& tree, Kinematics& m) const {
    const Vec3 f = force(tree, m, 0);
    add_force(tree, m, link[0], point(tree, m, 0), f);
    add_force(tree, m, link[1], point(tree, m, 1), -f);
  }
  // Of the wrench on `side` by the motion of the link at `by`.
  ForceDerivative derivative(const Tree& tree, const Kinematics& m, int side, int by) const {
    const Vec3 x = point(tree, m, side) - m.origin, y = point(tree, m, by) - m.origin;
    const Vec3 f = force(tree, m, side);
    const Vec3 w = link_twist(tree, m, link[by]).w;
    const double sign = by == side ? -1 : 1;
    // the point's displacement and velocity: dy = -[y] dphi + ds; dv_y = dv - [y] dw + w x dy
    Eigen::Matrix<double, 3, 6> Jy, forces, rates;
    Jy << -cross_matrix(y), Mat3::Identity();
    forces = sign * (k * Jy + c * cross_matrix(w) * Jy);
    rates = sign * c * Jy;
    ForceDerivative d;
    d.by_displacement << cross_matrix(x) * forces, forces;
    d.by_velocity << cross_matrix(x) * rates, rates;
    // the lever moves too
    if (by == side) d.by_displacement.topRows<3>() -= cross_matrix(f) * Jy;
    return d;
  }
};

TEST(MultibodyDerivatives, of_forces_between_links_of_one_tree) {
  Random random(13);
  for (int round = 0; round < 60; ++round) {
    const TreeState s(random_links(random, 7, false), random, true);
    const Tree& tree = s.tree;
    const Tie tie{{static_cast<int>(random.below(7)), static_cast<int>(random.below(7))},
                  {random_vector(random, 0.5), random_vector(random, 0.5)}};
    const Numbers rate = random_numbers(random, s.u.size(), 5);
    Kinematics k(tree);
    InverseDynamics work(tree);
    Linearisation linear(tree);
    Derivatives d(tree.nv());
    place(tree, s.q, s.u, s.around, k);
    const Vec3 origin = k.origin;
    tie.pull(tree, k);
    linear.clear_wrenches();
    for (int side : {0, 1})
      linear.add_wrench(tree, tie.link[side], tie.derivative(tree, k, side, side));
    linearise(tree, k, rate, linear, all(d.M), all(d.Kq), all(d.Ku));
    for (int side : {0, 1})
      add_cross_derivative({tree, k, linear, tie.link[side]}, {tree, k, linear, tie.link[1 - side]},
                           tie.derivative(tree, k, side, 1 - side),
                           static_cast<std::size_t>(tree.nv()), d.Kq.data(), d.Ku.data());
    const auto residual = [&](const Numbers& q, const Numbers& u) -> Column {
      place(tree, q, u, s.around, origin, k);
      tie.pull(tree, k);
      Numbers tau = s.zeros();
      inverse_dynamics(tree, k, rate, work, tau);
      return -column(tau);
    };
    expect_same(d, differences(s, residual), 1e-11);
  }
}

TEST(MultibodyDerivatives, of_the_chart_of_a_step) {
  Random random(14);
  for (int round = 0; round < 20; ++round) {
    const TreeState s(random_links(random, 7, false), random, false);
    const int n = s.tree.nv();
    Matrix G(n, n);
    for (int j = 0; j < n; ++j)
      G.col(j) = difference_of_order_8(0.01, [&](double h) -> Column {
        Numbers g = s.zeros();
        chart_rate(s.tree, numbers(h * Column::Unit(n, j)), s.u, g);
        return column(g);
      });
    Numbers r = random_numbers(random, s.u.size(), 1);
    const Column expected = (7 * Matrix::Identity(n, n) - G).lu().solve(column(r));
    solve_chart_rate(s.tree, s.u, 7, r);
    EXPECT_LT((column(r) - expected).norm(), 1e-11);
    // the chart's motion is that of the position's own rate
    const Numbers z = random_numbers(random, s.u.size(), 0.5);
    Numbers q(s.q.size()), rate(s.q.size()), g = s.zeros();
    displace(s.tree, s.q, z, q);
    position_rate(s.tree, q, s.u, rate);
    chart_rate(s.tree, z, s.u, g);
    const Column by_chart = difference_of_order_8(0.01, [&](double h) -> Column {
      Numbers moved(s.q.size());
      displace(s.tree, s.q, numbers(column(z) + h * column(g)), moved);
      return column(moved);
    });
    EXPECT_LT((by_chart - column(rate)).norm(), 1e-10);
    Numbers back = s.zeros();
    difference(s.tree, s.q, q, back);
    EXPECT_LT((column(back) - column(z)).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace tw::test
