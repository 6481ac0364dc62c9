// Blocks and balls on planes against closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic/group-arc-scenes.h"

namespace tw {
namespace {

using namespace group_scenes;

constexpr double twenty = 20 * pi / 180;

TEST(GroupArc, a_block_sinks_to_the_depth_that_carries_its_weight) {
  GroupStart start = cube_on_slope(0, 0.5, 0.2, 3);
  start.members[0].x.z() += 1e-5;
  CompleteArc arc(start);
  const double depth = 0.1 - arc.evaluate(0, 3).x.z();
  const ContactConstants c = constants(1, 0.2, 0.5);
  const double r = depth / c.hardening;
  EXPECT_NEAR(c.k * depth * (1 + r * r), g, 1e-6);
  EXPECT_NEAR(arc.contact_force(2, 3).normal_force, g / 4, 1e-6);
}

TEST(GroupArc, small_bounces_have_the_frequency_of_the_tangent_stiffness) {
  GroupStart start = ball_on_slope(0, 0, 0.1, 1);
  ContactConstants& c = start.contacts[0].law;
  c.b = 0;
  const double depth = static_depth(c, g), r = depth / c.hardening, amplitude = 1e-4 * depth;
  const double omega = std::sqrt(c.k * (1 + 3 * r * r));
  start.members[0].x.z() += amplitude;
  start.end = 10 * 2 * pi / omega;
  start.position_tolerance = 1e-6 * amplitude;
  start.velocity_tolerance = 1e-6 * amplitude * omega;
  CompleteArc arc(start);
  for (int i = 0; i <= 20; ++i) {
    const double time = i * start.end / 20.5;
    EXPECT_NEAR(arc.evaluate(0, time).x.z() - (0.1 - depth), amplitude * std::cos(omega * time),
                2e-4 * amplitude);
  }
}

// Positions from one second on, when the block has found its pitch and its stretches.
TEST(GroupArc, anchored_block_slides_down_with_g_sin_minus_mu_cos) {
  GroupStart start = cube_on_slope(twenty, 0.3, 0.2, 3);
  CompleteArc arc(start);
  const double a = g * (std::sin(twenty) - 0.3 * std::cos(twenty));
  const ContactConstants& c = start.contacts[0].law;
  const GroupSample first = arc.evaluate(0, 1);
  for (const double time : {0.1, 0.5, 1.0, 2.0}) {
    const GroupSample then = arc.evaluate(0, 1 + time);
    const double path = then.x.x() - first.x.x() - time * first.v.x();
    EXPECT_NEAR(path, 0.5 * a * time * time, c.mu * c.depth) << time;
    EXPECT_NEAR(then.v.x() - first.v.x(), a * time, 1e-6);
  }
  EXPECT_TRUE(arc.contact_force(0, 1).slipping);
}

TEST(GroupArc, smooth_block_slides_down_with_the_tail_of_the_arc_tangent) {
  CompleteArc arc(cube_on_slope(twenty, 0.3, 0.2, 3, FrictionLaw::smooth));
  // friction falls short of mu N by the share 2 v0/(pi v), v = v1 + a t to first order: the speed
  // gains mu g cos (2 v0/pi) ln(v/v1)/a more
  const double a = g * (std::sin(twenty) - 0.3 * std::cos(twenty));
  const double v1 = arc.evaluate(0, 1).v.x(), v2 = arc.evaluate(0, 3).v.x();
  const double gain = 0.3 * g * std::cos(twenty) * (2e-4 / pi) * std::log(v2 / v1) / a;
  EXPECT_NEAR(v2 - v1 - 2 * a, gain, 0.02 * gain);
}

TEST(GroupArc, anchored_block_below_the_friction_angle_comes_to_rest) {
  GroupStart start = cube_on_slope(twenty, 0.5, 0.2, 4);
  start.position_tolerance = 1e-8;
  start.velocity_tolerance = 1e-7;
  CompleteArc arc(start);
  const GroupSample settled = arc.evaluate(0, 2), later = arc.evaluate(0, 4);
  EXPECT_LT(later.v.norm(), 1e-12);
  EXPECT_LT((later.x - settled.x).norm(), 0.01 * start.position_tolerance);
  // moved by about the stretch that carries the weight, 2.1e-5 m, and its pitch
  EXPECT_LT(later.x.x(), 3 * g * std::sin(twenty) / start.contacts[0].law.kt);
  EXPECT_FALSE(arc.contact_force(0, 4).slipping);
}

// What is pressed to depth d hangs on tangential springs of y^2 kt, y its grip: it gives way by
// F/(y^2 kt).  The block is too heavy to turn.
TEST(GroupArc, friction_is_as_much_stiffer_as_the_spring_that_presses) {
  for (const double weights : {1.0, 30.0, 1000.0, 1e4}) {
    GroupStart start = cube_on_slope(0, 0.5, 0.2, 4);
    GroupMember& block = start.members[0];
    const ContactConstants& c = start.contacts[0].law;
    const double pull = 0.3 * weights * g, depth = spring_depth(c, 1, weights * g);
    block.moments = Vec3::Constant(1e15);
    block.x.z() = 0.1 - depth;
    block.force = Vec3(pull, 0, -weights * g);
    start.position_tolerance = 1e-6 * c.depth;
    start.velocity_tolerance = 1e-6 * std::sqrt(g * c.depth);
    CompleteArc arc(start);
    const double grip = friction_grip(c, depth), given_way = pull / (grip * grip * c.kt);
    EXPECT_NEAR(arc.evaluate(0, 4).x.x(), given_way, 1e-4 * given_way) << weights;
    EXPECT_FALSE(arc.contact_force(0, 4).slipping);
  }
}

TEST(GroupArc, smooth_block_creeps_at_the_terminal_speed) {
  CompleteArc arc(cube_on_slope(twenty, 0.5, 0.2, 4, FrictionLaw::smooth));
  const double speed = 1e-4 * std::tan(pi / 2 * std::tan(twenty) / 0.5);
  EXPECT_NEAR(arc.evaluate(0, 4).v.x(), speed, 1e-6 * speed);
}

TEST(GroupArc, a_ball_rolls_down_with_five_sevenths_of_g_sin) {
  for (const FrictionLaw law : {FrictionLaw::anchored, FrictionLaw::smooth}) {
    CompleteArc arc(ball_on_slope(twenty, 0.5, 0.1, 2, law));
    const double a = 5.0 / 7 * g * std::sin(twenty);
    const GroupSample end = arc.evaluate(0, 2);
    EXPECT_NEAR(end.v.x() / (2 * a), 1, 1e-4);
    EXPECT_NEAR(end.x.x() / (2 * a), 1, 1e-4);
  }
}

TEST(GroupArc, a_sliding_ball_ends_rolling_at_five_sevenths_of_its_speed) {
  for (const FrictionLaw law : {FrictionLaw::anchored, FrictionLaw::smooth}) {
    GroupStart start = ball_on_slope(0, 0.3, 0.1, 3, law);
    start.members[0].v = Vec3(2, 1, 0);
    CompleteArc arc(start);
    const GroupSample end = arc.evaluate(0, 3);
    EXPECT_NEAR(end.v.x() / (2 * 5.0 / 7), 1, 1e-4);
    EXPECT_NEAR(end.v.y() / (5.0 / 7), 1, 1e-4);
    EXPECT_LT(arc.contact_force(0, 3).velocity.norm(), 1e-5);
  }
}

TEST(GroupArc, a_rolling_ball_keeps_its_speed_and_height) {
  GroupStart start = ball_on_slope(0, 0.5, 0.1, 5);
  start.members[0].v = Vec3(1, 0, 0);
  // the contact point is one radius below the centre, whatever the depth
  start.members[0].L = Vec3(0, start.members[0].moments[0] / 0.1, 0);
  CompleteArc arc(start);
  const GroupSample end = arc.evaluate(0, 5);
  EXPECT_NEAR(end.v.x(), 1, 1e-9);
  EXPECT_NEAR(end.x.x(), 5, 1e-9);
  EXPECT_NEAR(end.x.z(), start.members[0].x.z(), 1e-9);
}

TEST(GroupArc, a_block_on_an_accelerating_belt_goes_with_it) {
  // s = t^2/2 for 1 s
  class Belt : public Trajectory {
   public:
    Pose pose(double t) const override { return {Vec3(0.5 * t * t, 0, 0), Quat::Identity()}; }
    Twist twist(double t) const override { return {Vec3(t, 0, 0), Vec3::Zero()}; }
    MotionBounds bounds(double, double to) const override {
      MotionBounds bounds;
      bounds.path = bounds.acceleration = Aabb::everywhere();
      bounds.speed = to;
      bounds.turn = 0;
      bounds.valid_until = to;
      return bounds;
    }
  };
  GroupStart start = cube_on_slope(0, 0.5, 0.2, 1);
  start.outside = {std::make_shared<Belt>()};
  CompleteArc arc(start);
  const GroupSample end = arc.evaluate(0, 1);
  EXPECT_NEAR(end.v.x(), 1, 1e-6);
  // behind by the stretch that carries m a, 6.4e-6 m, and the pitch
  EXPECT_LT(end.x.x(), 0.5 - 1 / start.contacts[0].law.kt);
  EXPECT_NEAR(end.x.x(), 0.5 - 1 / start.contacts[0].law.kt, 5e-6);
}

}  // namespace
}  // namespace tw
