// Checks of what goes on as foreseen are rare, and nothing is missed for it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

std::int64_t checks_of(const World& world) { return count_of(world.statistics(), "group_checks"); }

// A ball of 0.2 m that rolls at 1 m/s moves by a twentieth of its size in 10 ms; its contact with a
// plane is followed exactly, so the plane is looked at eight times as rarely.
TEST(Foreseen, a_ball_that_rolls_is_checked_as_rarely_as_what_hardly_moves) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, {1, 0, 0}, {0, 10, 0});
  world.advance(5);
  EXPECT_LT(checks_of(world), 100);
  EXPECT_LT((world.state(ball).position - Vec3(5, 0, 0.1)).norm(), 1e-9);
  EXPECT_LT((world.state(ball).velocity - Vec3(1, 0, 0)).norm(), 1e-9);
}

// A box slides to its stop, v^2/(2 mu g) away.
TEST(Foreseen, a_box_that_slides_stops_where_it_should) {
  World world;
  const double v = 2, mu = 0.1;
  set_contact_for_all(world, 0, mu);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId box = world.add_body(body_of(make_box({0.2, 0.2, 0.2}), {0, 0, 0.1}, {v, 0, 0}));
  world.advance(3);
  EXPECT_LT(checks_of(world), 120);
  EXPECT_NEAR(world.state(box).position.x(), v * v / (2 * mu * g), 1e-3);
  EXPECT_EQ(world.state(box).velocity.norm(), 0);
}

// What comes between two checks is found when it comes: a ball that has rolled for two seconds
// strikes a block at the time that is known, and one that rolls off a table does not roll on.
TEST(Foreseen, what_comes_meanwhile_is_not_missed) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  BodyDef table;
  table.shape = make_box({8, 2, 1});
  table.position = Vec3(0, 0, -0.5);
  table.fixed = true;
  world.add_body(table);
  BodyDef block;
  block.shape = make_box({0.2, 1, 1});
  block.position = Vec3(2, 0.5, 0.5);
  block.fixed = true;
  const BodyId wall = world.add_body(block);
  const double r = 0.1, v = 0.7;
  const BodyId one = add_ball(world, r, {0, 0.5, r}, {v, 0, 0}, {0, v / r, 0});
  const BodyId other = add_ball(world, r, {0, -0.5, r}, {v, 0, 0}, {0, v / r, 0});
  std::vector<double> struck;
  world.add_collision_observer([&](const Collision& c) {
    if (c.body1 == wall || c.body2 == wall) struck.push_back(c.time);
  });
  world.advance(4 / v + 1);
  ASSERT_FALSE(struck.empty());
  EXPECT_NEAR(struck.front(), (1.9 - r) / v, 1e-9);
  EXPECT_LT(world.state(other).position.z(), -2);
  EXPECT_LT(world.state(one).position.x(), 1.9 - 0.99 * r);
}

}  // namespace
}  // namespace tw::test
