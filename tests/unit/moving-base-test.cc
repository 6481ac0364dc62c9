// What hangs on a body whose motion is given: rates of the motion, corners, and what a jump does to
// joints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/moving-base.h"

#include <gtest/gtest.h>

#include "integrate/given/keyframes.h"
#include "math/rotation-vector.h"
#include "multibody/accounts.h"
#include "support/motions.h"
#include "support/random-tree.h"
#include "support/scene.h"

namespace tw::test {
namespace {

using namespace multibody;

TEST(RotationVector, angular_acceleration_is_the_rate_of_angular_velocity) {
  Random random(11);
  for (const double length : {1e-3, 0.1, 0.49, 0.51, 1.5, 3.0})
    for (int i = 0; i < 20; ++i) {
      const Vec3 theta = length * random_vector(random, 1).normalized(),
                 rate = random_vector(random, 2), change = random_vector(random, 2);
      const auto at = [&](double t) {
        return angular_velocity(theta + t * rate + 0.5 * t * t * change, rate + t * change);
      };
      const double t = 1e-4;
      const Vec3 expected = (at(-2 * t) - 8 * at(-t) + 8 * at(t) - at(2 * t)) / (12 * t);
      EXPECT_LT((angular_acceleration(theta, rate, change) - expected).norm(), 1e-10);
    }
}

std::vector<std::pair<const char*, TrajectoryPtr>> motions() {
  Random random(12);
  std::vector<Keyframe> frames;
  for (int i = 0; i < 5; ++i)
    frames.push_back({-0.3 + 0.37 * i, random_vector(random, 1), random_attitude(random)});
  const auto circling = [](double t) {
    return Pose{{std::cos(3 * t), std::sin(3 * t), 0.2 * std::sin(11 * t)},
                rotation_by(std::sin(2 * t) * Vec3(1, 2, -2)) *
                    rotation_by(Vec3(0.3 * std::cos(5 * t), 0, t))};
  };
  return {{"straight keyframes", make_keyframes(frames, false)},
          {"smooth keyframes", make_keyframes(frames, true)},
          {"a procedure", Sampled(circling).motion}};
}

TEST(GivenMotion, twist_rates_are_those_of_the_twist_and_bounds_hold) {
  Random random(13);
  for (const auto& [name, motion] : motions())
    for (int i = 0; i < 300; ++i) {
      const double from = random.real(-0.4, 1.2), to = from + random.real(0, 0.2);
      const MotionRates most = motion->most_rates(from, to);
      const double t = 0.5 * (from + to), apart = 1e-5;
      if (motion->next_corner(t - 4 * apart, t + 4 * apart) < never) continue;
      const auto slope = [&](auto&& of) {
        return Vec3((of(t + apart) - of(t - apart)) / (2 * apart));
      };
      const Vec3 a = slope([&](double s) { return motion->twist(s).v; }),
                 alpha = slope([&](double s) { return motion->twist(s).w; });
      const Vec3 jerk = slope([&](double s) { return motion->twist_rates(s).v; }),
                 turn_jerk = slope([&](double s) { return motion->twist_rates(s).w; });
      const Twist rates = motion->twist_rates(t), twist = motion->twist(t);
      EXPECT_LT((rates.v - a).norm(), 1e-5 * (1 + a.norm())) << name;
      EXPECT_LT((rates.w - alpha).norm(), 1e-5 * (1 + alpha.norm())) << name;
      const auto holds = [&, kind = name](double value, double bound) {
        EXPECT_LE(value, bound * (1 + 1e-6) + 1e-5) << kind;
      };
      holds(twist.v.norm(), most.speed);
      holds(twist.w.norm(), most.turn);
      holds(rates.v.norm(), most.acceleration);
      holds(rates.w.norm(), most.turn_change);
      holds(jerk.norm(), most.jerk);
      holds(turn_jerk.norm(), most.turn_jerk);
    }
}

TEST(GivenMotion, corners_are_found_where_they_are) {
  const TrajectoryPtr straight =
      make_keyframes({{0.5, Vec3::Zero(), {}}, {1, {1, 0, 0}, {}}, {2, {1, 1, 0}, {}}}, false);
  EXPECT_EQ(straight->next_corner(0, 3), 0.5);
  EXPECT_EQ(straight->next_corner(0.5, 3), 1);
  EXPECT_EQ(straight->next_corner(1, 2), 2);
  EXPECT_EQ(straight->next_corner(1, 1.5), never);
  EXPECT_EQ(straight->next_corner(2, 9), never);

  const auto bounce = [](double t) {
    return Pose{{0, 0, std::abs(std::sin(3 * t))}, Quat::Identity()};
  };
  const Sampled kinked(bounce);
  const double kink = pi / 3;
  const double first = kinked.motion->next_corner(0.01, 2);
  EXPECT_NEAR(first, kink, 1e-7);
  EXPECT_EQ(kinked.motion->next_corner(0.01, 1), never);
  // the kink is one short piece
  const double second = kinked.motion->next_corner(first, 2);
  EXPECT_NEAR(second, kink, 1e-7);
  EXPECT_EQ(kinked.motion->next_corner(second, 2), never);

  const Sampled ends([](double t) {
    TW_REQUIRE(t < 0.7, "no further");
    return Pose{{t, 0, 0}, Quat::Identity()};
  });
  EXPECT_NEAR(ends.motion->next_corner(0, 2), 0.7, 1e-12);
  EXPECT_EQ(ends.motion->next_corner(0, 0.6), never);
}

Multibody carried(const Tree& tree, const TrajectoryPtr& motion, const Pose& offset) {
  return {0, "tree", {}, tree, Frame(motion->pose(0) * offset), {}, {}, false, motion, offset};
}

TEST(MovingBase, its_place_velocity_and_acceleration_are_of_one_motion) {
  Random random(14);
  const Tree tree(random_links(random, 1, false));
  for (const auto& [name, motion] : motions()) {
    const Multibody multibody =
        carried(tree, motion, {random_vector(random, 0.5), random_attitude(random)});
    const MovingBase base(multibody);
    for (int i = 0; i < 50; ++i) {
      const double t = random.real(-0.2, 1), apart = 1e-6;
      if (motion->next_corner(t - 2 * apart, t + 2 * apart) < never) continue;
      BaseMotion here, before, after;
      base.set(t, here);
      base.set(t - apart, before);
      base.set(t + apart, after);
      EXPECT_LT(((after.base.p - before.base.p) / (2 * apart) - here.v).norm(), 1e-7) << name;
      EXPECT_LT(((after.v - before.v) / (2 * apart) - here.a).norm(), 1e-5 * (1 + here.a.norm()))
          << name;
      EXPECT_LT(((after.w - before.w) / (2 * apart) - here.alpha).norm(),
                1e-5 * (1 + here.alpha.norm()))
          << name;
    }
  }
}

// No impulse acts along the joints: the momentum of all links along each stays.
TEST(MovingBase, a_jump_gives_no_impulse_along_the_joints) {
  Random random(15);
  for (int trial = 0; trial < 20;) {
    const Tree tree(random_links(random, 4, false));
    // what floats hangs on nothing, what is welded moves along
    if (tree.nv() == 0 || tree.link(0).joint == JointKind::free) continue;
    ++trial;
    const TrajectoryPtr motion =
        make_keyframes({{0, Vec3::Zero(), Quat::Identity()},
                        {1, random_vector(random, 1), rotation_by({0, 0, 2})},
                        {2, random_vector(random, 1), random_attitude(random)}},
                       false);
    const Multibody multibody =
        carried(tree, motion, {random_vector(random, 0.5), random_attitude(random)});
    MultibodyState joints;
    joints.q.resize(static_cast<std::size_t>(tree.nq()));
    joints.u.resize(static_cast<std::size_t>(tree.nv()));
    neutral_position(tree, joints.q);
    for (double& u : joints.u) u = random.real(-2, 2);
    const MovingBase base(multibody);
    joints.base = base.twist_before(1);
    // sum over the links of axis . momentum, about the origin
    const auto momentum_along = [&] {
      BaseMotion around;
      base.set(1, around);
      around.v = joints.base.v, around.w = joints.base.w;
      Kinematics k(tree);
      place(tree, joints.q, joints.u, around, k);
      std::vector<Force> momentum(k.nodes.size());
      Numbers along(joints.u.size());
      for (int i = tree.node_count() - 1; i >= first_node; --i) {
        Force& own = momentum[static_cast<std::size_t>(i)];
        own += k.node(i).inertia(tree.node(i).mass) * k.node(i).V;
        const Node& node = tree.node(i);
        for (int d = node.u; d < node.u + node.dofs; ++d)
          along[static_cast<std::size_t>(d)] = dot(k.axis(d), own);
        momentum[static_cast<std::size_t>(node.parent)] += own;
      }
      return along;
    };
    const Numbers before = momentum_along(), u = joints.u;
    follow_base(multibody, 1, joints);
    const Numbers after = momentum_along();
    EXPECT_NE(u, joints.u);
    double largest = 0;
    for (const double p : before) largest = std::max(largest, std::abs(p));
    for (std::size_t k = 0; k < before.size(); ++k)
      EXPECT_NEAR(after[k], before[k], 1e-11 * (1 + largest));
    // once
    const Numbers settled = joints.u;
    follow_base(multibody, 1, joints);
    EXPECT_EQ(settled, joints.u);
  }
}

}  // namespace
}  // namespace tw::test
