// Limits of spherical joints: their angles against differences, and their stops.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/limits.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "multibody/inverse-kinematics.h"
#include "multibody/jacobian.h"
#include "support/random-tree.h"

namespace tw::test {
namespace {

using namespace multibody;

constexpr double limit = 0.7;

// A rod on a spherical joint; `swings`: the limit is of its axis alone.
Tree rod(bool swings) {
  LinkSpec link;
  link.name = "rod";
  link.mass = 2;
  link.center_of_mass = {0, 0, -0.5};
  link.inertia = Vec3(0.02, 0.03, 0.01).asDiagonal();
  link.joint.kind = JointKind::spherical;
  link.joint.axes[0].upper = limit;
  link.joint.axes[0].restitution = 0.4;
  link.joint.axes[0].stop_stiffness = 1e3;
  if (swings) link.joint.swinging = Vec3(0.5, -1, 2);
  return Tree({link});
}

Quat turned(const Quat& q, const Vec3& by) { return (q * rotation_by(by)).normalized(); }

TEST(MultibodyLimits, an_angle_grows_along_its_direction) {
  Random random(31);
  for (const bool swings : {false, true}) {
    const Tree tree = rod(swings);
    const Axis& axis = tree.axes()[0];
    for (int round = 0; round < 100; ++round) {
      const Quat q = random_attitude(random);
      const Vec3 along = random_vector(random, 1);
      const LimitedAngle at = limited_angle(axis, q);
      if (at.angle < 0.05 || at.angle > pi - 0.05) continue;
      const double by = difference_of_order_8(
          1e-3, [&](double h) { return limited_angle(axis, turned(q, h * along)).angle; });
      EXPECT_NEAR(at.direction.dot(along), by, 1e-9);
      EXPECT_NEAR(at.direction.norm(), 1, 1e-15);
      const Vec3 change = difference_of_order_8(1e-3, [&](double h) -> Vec3 {
        return limited_angle(axis, turned(q, h * along)).direction;
      });
      EXPECT_LT((at.direction_by_turn * along - change).norm(), 1e-8 * (1 + change.norm()));
      EXPECT_NEAR(limited_angle(axis, Quat(-q.coeffs())).angle, at.angle, 1e-15);
    }
  }
}

TEST(MultibodyLimits, an_angle_is_what_was_turned_or_swung) {
  const Tree whole = rod(false), cone = rod(true);
  const Vec3 axis = Vec3(0.5, -1, 2).normalized(), across = axis.unitOrthogonal();
  const Quat twist = rotation_by(2.5 * axis);
  EXPECT_NEAR(limited_angle(whole.axes()[0], twist).angle, 2.5, 1e-15);
  EXPECT_NEAR(limited_angle(cone.axes()[0], twist).angle, 0, 1e-15) << "turning about it is free";
  const Quat both = rotation_by(0.6 * across) * twist;
  EXPECT_NEAR(limited_angle(cone.axes()[0], both).angle, 0.6, 1e-15);
  EXPECT_EQ(limited_angle(whole.axes()[0], Quat::Identity()).direction, Vec3::Zero());
}

TEST(MultibodyLimits, what_is_beyond_goes_back_by_the_shortest_way) {
  Random random(32);
  for (const bool swings : {false, true}) {
    const Tree tree = rod(swings);
    const Axis& axis = tree.axes()[0];
    for (int round = 0; round < 100; ++round) {
      const Quat q = random_attitude(random), within = within_limit(axis, q);
      const double angle = limited_angle(axis, q).angle;
      EXPECT_LE(limited_angle(axis, within).angle, limit);
      EXPECT_NEAR(q.angularDistance(within), std::max(angle - limit, 0.0), 1e-12);
    }
  }
}

TEST(MultibodyLimits, a_stop_pushes_back_and_knows_its_derivatives) {
  Random random(33);
  const std::vector<Stop> stops{Stop::upper};
  Inputs inputs;
  inputs.stops = stops;
  for (const bool swings : {false, true}) {
    const Tree tree = rod(swings);
    const Axis& axis = tree.axes()[0];
    for (int round = 0; round < 40; ++round) {
      // a little beyond, and going out
      Quat edge = Quat::Identity();
      while (limited_angle(axis, edge).angle < limit - 1e-9)
        edge = within_limit(axis, random_attitude(random));
      const LimitedAngle there = limited_angle(axis, edge);
      const Vec3 n = there.direction;
      const Quat at = turned(edge, 2e-3 * n);
      const Vec3 u = random_vector(random, 1e-2) + 1e-3 * n;
      const auto torque = [&](const Quat& where, const Vec3& velocity) -> Vec3 {
        Numbers q(4), tau(3);
        set_quaternion(q.data(), where);
        joint_torques(tree, q, Numbers{velocity[0], velocity[1], velocity[2]}, inputs, tau);
        return vector_at(tau.data());
      };
      const double depth = limited_angle(axis, at).angle - limit, rate = n.dot(u);
      EXPECT_LT((torque(at, u) + 1e3 * depth * (1 + stop_damping(axis) * rate) * n).norm(), 1e-9);
      EXPECT_EQ(torque(turned(edge, -1e-3 * n), u), Vec3::Zero()) << "within the limit";
      Numbers q(4), Kq(9, 0.0), Ku(9, 0.0);
      set_quaternion(q.data(), at);
      add_joint_derivatives(tree, q, Numbers{u[0], u[1], u[2]}, inputs, Kq, Ku);
      for (int j = 0; j < 3; ++j) {
        const Vec3 e = Vec3::Unit(j);
        const Vec3 by_q = difference_of_order_8(
            1e-5, [&](double h) -> Vec3 { return torque(turned(at, h * e), u); });
        const Vec3 by_u =
            difference_of_order_8(1e-5, [&](double h) -> Vec3 { return torque(at, u + h * e); });
        EXPECT_LT((vector_at(&Kq[static_cast<std::size_t>(3 * j)]) - by_q).norm(), 1e-6);
        EXPECT_LT((vector_at(&Ku[static_cast<std::size_t>(3 * j)]) - by_u).norm(), 1e-6);
      }
    }
  }
}

TEST(MultibodyLimits, inverse_kinematics_keeps_within_them) {
  Random random(34);
  int reached = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<LinkSpec> links;
    for (int i = 0; i < 3; ++i) {
      links.push_back(random_link(random, JointKind::spherical, i, i - 1, false));
      links.back().joint.axes[0].upper = limit;
      if (random.below(2) == 0) links.back().joint.swinging = random_vector(random, 1);
    }
    const TreeState s(links, random, false);
    Numbers q = s.q;
    for (const Axis& axis : s.tree.axes()) {
      double* at = &q[static_cast<std::size_t>(axis.q)];
      set_quaternion(at, within_limit(axis, quaternion_at(at)));
    }
    Kinematics k(s.tree);
    place(s.tree, q, s.u, s.around, k);
    Target target;
    target.link = 2;
    target.position = link_frame(s.tree, k, 2).p;
    target.attitude = Quat(link_frame(s.tree, k, 2).R);
    Numbers start(q.size());
    neutral_position(s.tree, start);
    SearchOptions options;
    options.starts = 6;
    const Reached found = inverse_kinematics(s.tree, s.around, target, start, options);
    if (!found.q) continue;
    ++reached;
    for (const Axis& axis : s.tree.axes()) EXPECT_LE(limited(axis, *found.q), limit);
  }
  EXPECT_GE(reached, 50);
}

}  // namespace
}  // namespace tw::test
