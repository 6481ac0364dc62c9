// Rolling and sliding against closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "support/schedule.h"

namespace tw::test {
namespace {

constexpr double g = 9.81;

// How far a round body of inertia beta m r^2 runs down a slope from rest.
struct Descent {
  double moved = 0, speed = 0, spin = 0;
};

Descent run_down(const ShapePtr& shape, double radius, double angle, double mu, double duration,
                 const Quat& attitude = Quat::Identity()) {
  World world;
  set_contact_for_all(world, 0, mu);
  const Vec3 normal(std::sin(angle), 0, std::cos(angle)),
      down(std::cos(angle), 0, -std::sin(angle));
  add_wall(world, normal, 0);
  BodyDef def = body_of(shape, radius * normal, Vec3::Zero());
  def.orientation = attitude;
  const BodyId id = world.add_body(def);
  world.advance(duration);
  const BodyState s = world.state(id);
  return {(s.position - def.position).dot(down), s.velocity.dot(down), s.angular_velocity.y()};
}

TEST(Rolling, ball_rolls_down_a_slope) {
  const double angle = 0.3, a = 5.0 / 7 * g * std::sin(angle);
  const Descent run = run_down(make_sphere(0.2), 0.2, angle, 0.5, 2);
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.moved, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(0.2 * run.spin, run.speed, 1e-4 * run.speed);
}

TEST(Rolling, ball_slips_down_a_steep_slope) {
  // rolling would need mu >= 2/7 tan
  const double angle = 0.7, mu = 0.1, a = g * (std::sin(angle) - mu * std::cos(angle));
  const double spin = 5.0 / 2 * mu * g * std::cos(angle) / 0.2;
  const Descent run = run_down(make_sphere(0.2), 0.2, angle, mu, 2);
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.spin, 2 * spin, 1e-4 * 2 * spin);
}

TEST(Rolling, cylinder_rolls_down_a_slope) {
  const double angle = 0.2, a = 2.0 / 3 * g * std::sin(angle);
  const Descent run =
      run_down(make_cylinder(0.2, 0.6), 0.2, angle, 0.5, 2, rotation_by(Vec3(pi / 2, 0, 0)));
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.moved, 2 * a, 1e-4 * 2 * a);
}

TEST(Rolling, sliding_ball_ends_at_five_sevenths) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, {4, 0, 0});
  world.advance(2);  // it rolls after 2/7 v0/(mu g) = 0.39 s
  const BodyState s = world.state(ball);
  EXPECT_NEAR(s.velocity.x(), 4 * 5.0 / 7, 1e-4 * 4 * 5.0 / 7);
  EXPECT_NEAR(0.1 * s.angular_velocity.y(), s.velocity.x(), 1e-4 * s.velocity.x());
}

TEST(Rolling, ball_keeps_rolling) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, {3, 0, 0}, {0, 30, 0});
  world.advance(10);
  EXPECT_NEAR(world.state(ball).velocity.x(), 3, 1e-6);
  EXPECT_NEAR(world.state(ball).position.x(), 30, 1e-5);
}

}  // namespace
}  // namespace tw::test
