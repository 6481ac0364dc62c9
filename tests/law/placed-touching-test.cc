// What is placed touching starts loaded: it stands still from the first instant on, and what has no
// balance starts to move as the formulas for rigid bodies say.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "determinism/compare-schedules.h"
#include "support/scenes.h"

namespace tw::test {
namespace {

void add_floor_at(World& world, double angle, double friction) {
  set_contact_for_all(world, 0, friction);
  add_wall(world, {std::sin(angle), 0, std::cos(angle)}, 0);
}

// A kilogram a cubic metre.
BodyDef light(const ShapePtr& shape, const Vec3& position) {
  BodyDef def = body_of(shape, position, Vec3::Zero());
  def.density = 1;
  return def;
}

// A body of unit size on the slope, its centre at the height `half` above it.
BodyId add_on_slope(World& world, const ShapePtr& shape, double angle, double half) {
  BodyDef def = light(shape, half * Vec3(std::sin(angle), 0, std::cos(angle)));
  def.orientation = rotation_by(Vec3(0, angle, 0));
  return world.add_body(def);
}

void add_pyramid(World& world, int rows) {
  add_floor_at(world, 0, 0.5);
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      world.add_body(light(make_box({0.9, 1, 1}), {i + 0.5 * row, 0, row + 0.5}));
}

// Balls between walls, two on three.
void add_balls(World& world, double friction) {
  add_floor_at(world, 0, friction);
  add_wall(world, Vec3::UnitX(), 0);
  add_wall(world, -Vec3::UnitX(), -3);
  for (const double x : {0.5, 1.5, 2.5}) add_ball(world, 0.5, {x, 0, 0.5}, Vec3::Zero());
  for (const double x : {1.0, 2.0})
    add_ball(world, 0.5, {x, 0, 0.5 + std::sqrt(0.75)}, Vec3::Zero());
}

// A semicircle of wedges that touch.
void add_arch(World& world, int stones) {
  add_floor_at(world, 0, 0.7);
  for (int i = 0; i < stones; ++i) {
    const double from = pi * i / stones, to = pi * (i + 1) / stones, middle = 0.5 * (from + to);
    const Vec3 center = 1.15 * Vec3(std::cos(middle), 0, std::sin(middle));
    std::vector<Vec3> corners;
    for (const double angle : {from, to})
      for (const double r : {1.0, 1.3})
        for (const double y : {-0.2, 0.2})
          corners.push_back(Vec3(r * std::cos(angle), y, r * std::sin(angle)) - center);
    world.add_body(light(make_hull(corners), center));
  }
}

// The farthest that a body goes and turns within `duration`, looked at often at first.
struct Drift {
  double way = 0, turn = 0, jump = 0, rise = 0;  // m, rad, J
};

Drift drift_of(World& world, double duration) {
  std::vector<BodyState> start;
  for (BodyId id = 0; id < world.body_count(); ++id) start.push_back(world.state(id));
  const double energy = world.total_energy();
  double lowest = energy;
  Drift drift;
  const double start_time = world.time();
  for (double when = 1e-6; when < duration; when *= 2) {
    if (when <= start_time) continue;
    world.advance(when);
    for (BodyId id = 0; id < world.body_count(); ++id) {
      const BodyState now = world.state(id);
      drift.way = std::max(drift.way, (now.position - start[id].position).norm());
      drift.turn = std::max(drift.turn, now.orientation.angularDistance(start[id].orientation));
    }
    if (when == 1e-6) drift.jump = std::abs(world.total_energy() - energy);
    drift.rise = std::max(drift.rise, world.total_energy() - lowest);
    lowest = std::min(lowest, world.total_energy());
  }
  return drift;
}

void expect_still(const std::function<void(World&)>& fill, double way, double turn) {
  World world;
  fill(world);
  const Drift drift = drift_of(world, 10);
  EXPECT_LT(drift.way, way);
  EXPECT_LT(drift.turn, turn);
  EXPECT_LT(drift.jump, 1e-7);
  EXPECT_LT(drift.rise, 1e-7);
}

TEST(PlacedTouching, stacks_stand_still) {
  for (const int count : {1, 10, 50})
    expect_still(
        [count](World& world) {
          add_floor_at(world, 0, 0.5);
          for (int i = 0; i < count; ++i)
            world.add_body(light(make_box({1, 1, 1}), {0, 0, i + 0.5}));
        },
        1e-9, 1e-9);
}

TEST(PlacedTouching, a_box_on_a_slope_does_not_creep) {
  expect_still(
      [](World& world) {
        const double angle = 20 * pi / 180;
        add_floor_at(world, angle, 0.5);
        add_on_slope(world, make_box({1, 1, 1}), angle, 0.5);
      },
      1e-9, 1e-9);
}

// On a slope its own diagonal less 0.001 rad steep.
TEST(PlacedTouching, a_tall_box_does_not_lean_before_its_balance_is_lost) {
  expect_still(
      [](World& world) {
        const double angle = std::atan2(1, 3) - 0.001;
        add_floor_at(world, angle, 0.5);
        add_on_slope(world, make_box({1, 1, 3}), angle, 1.5);
      },
      1e-9, 1e-9);
}

TEST(PlacedTouching, pyramids_and_balls_stand_still) {
  expect_still([](World& world) { add_pyramid(world, 6); }, 1e-5, 1e-5);
  for (const double friction : {0.0, 0.5})
    expect_still([friction](World& world) { add_balls(world, friction); }, 1e-5, 1e-5);
}

TEST(PlacedTouching, arches_stand_still) {
  for (const int stones : {15, 25, 51}) {
    World world;
    add_arch(world, stones);
    EXPECT_LT(drift_of(world, 10).way, 1e-5) << stones;
  }
}

TEST(PlacedTouching, a_box_too_steep_slides_as_coulomb_says_from_the_start) {
  World world;
  const double angle = 40 * pi / 180, friction = 0.3;
  add_floor_at(world, angle, friction);
  const BodyId box = add_on_slope(world, make_box({1, 1, 1}), angle, 0.5);
  const Vec3 start = world.state(box).position;
  const double acceleration = g * (std::sin(angle) - friction * std::cos(angle));
  for (const double when : {1e-3, 0.1, 1.0}) {
    world.advance(when);
    const double way = 0.5 * acceleration * when * when;
    EXPECT_NEAR((world.state(box).position - start).norm(), way, 1e-6 * way) << when;
  }
}

TEST(PlacedTouching, a_ball_on_a_slope_rolls_from_the_start) {
  World world;
  const double angle = 20 * pi / 180;
  add_floor_at(world, angle, 0.5);
  const BodyId ball = add_on_slope(world, make_sphere(0.5), angle, 0.5);
  const Vec3 start = world.state(ball).position;
  for (const double when : {1e-3, 0.1, 1.0}) {
    world.advance(when);
    const double way = 0.5 * (5.0 / 7) * g * std::sin(angle) * when * when;
    EXPECT_NEAR((world.state(ball).position - start).norm(), way, 1e-6 * way) << when;
  }
}

// The springs give back what they hold: the block rises as far as ten weights had pressed it, five
// depths and a half at the law's hardening, and sinks to where it would have settled.
TEST(PlacedTouching, what_a_load_leaves_is_not_thrown_up) {
  World world;
  add_floor_at(world, 0, 0.5);
  std::vector<BodyId> blocks;
  for (int i = 0; i < 10; ++i)
    blocks.push_back(world.add_body(light(make_box({1, 1, 1}), {0, 0, i + 0.5})));
  world.advance(0.2);
  for (int i = 1; i < 10; ++i) world.remove_body(blocks[static_cast<std::size_t>(i)]);
  double lowest = world.total_energy(), highest = 0;
  for (int i = 1; i <= 500; ++i) {
    world.advance(0.2 + 0.001 * i);
    highest = std::max(highest, world.state(blocks[0]).position.z() - 0.5);
    EXPECT_LT(world.total_energy(), lowest + 1e-5) << i;
    lowest = std::min(lowest, world.total_energy());
  }
  EXPECT_LT(highest, 1e-3);
  EXPECT_NEAR(world.state(blocks[0]).position.z(), 0.5, 3e-4);
}

// What comes later is placed like what was there from the beginning.
TEST(PlacedTouching, a_block_put_on_a_stack_at_rest_moves_nothing) {
  World world;
  add_floor_at(world, 0, 0.5);
  for (int i = 0; i < 9; ++i) world.add_body(light(make_box({1, 1, 1}), {0, 0, i + 0.5}));
  world.advance(3);
  world.add_body(light(make_box({1, 1, 1}), {0, 0, 9.5}));
  std::vector<BodyState> start;
  for (BodyId id = 0; id < world.body_count(); ++id) start.push_back(world.state(id));
  world.advance(6);
  for (BodyId id = 0; id < world.body_count(); ++id)
    EXPECT_LT((world.state(id).position - start[id].position).norm(), 1e-9) << id;
}

// What falls farther than bodies may overlap comes down, and nobody gives it a load.
TEST(PlacedTouching, what_falls_starts_without_a_load) {
  World world;
  add_floor_at(world, 0, 0.5);
  world.add_body(light(make_box({1, 1, 1}), {0, 0, 0.5 + 1e-5}));
  world.advance(3);
  EXPECT_EQ(number_of(world.statistics(), "placed_energy"), 0);
}

// All that touch come together at their first touch, and are loaded once: before, each of the
// stones found new loads for those that hung together so far (94 s of CPU for two seconds).
TEST(PlacedTouching, an_arch_of_301_stones_stands_at_once) {
  World world;
  add_arch(world, 301);
  const Drift drift = drift_of(world, 0.5);
  EXPECT_LT(drift.way, 1e-4);
  EXPECT_LT(count_of(world.statistics(), "implicit_steps"), 1000);
  EXPECT_GT(number_of(world.statistics(), "placed_energy"), 0);
}

TEST(PlacedTouching, observers_hear_of_every_pair_that_comes_to_touch) {
  World world;
  add_floor_at(world, 0, 0.5);
  for (int i = 0; i < 4; ++i) world.add_body(light(make_box({1, 1, 1}), {0, 0, i + 0.5}));
  std::vector<Collision> heard;
  world.add_collision_observer([&](const Collision& c) { heard.push_back(c); },
                               CollisionKind::fusion);
  world.advance(0.5);
  EXPECT_EQ(count_of(world.statistics(), "fusions"), 4);
  EXPECT_EQ(count_of(world.statistics(), "collisions"), 0);
  ASSERT_EQ(heard.size(), 4u);
  for (const Collision& c : heard) {
    EXPECT_EQ(c.body2, c.body1 + 1);
    EXPECT_NEAR(c.normal.z(), 1, 1e-12);
    EXPECT_NEAR(c.point.z(), c.body1, 1e-9);
    EXPECT_EQ(c.speed, 0);
  }
}

// A pair that touches where it was put and closes fast is left to its impact.
TEST(PlacedTouching, what_touches_and_closes_fast_strikes) {
  World world;
  set_contact_for_all(world, 1, 0);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId low = world.add_body(light(make_box({1, 1, 1}), {0, 0, 0.5}));
  BodyDef fast = light(make_box({1, 1, 1}), {1, 0, 0.5});
  fast.velocity = {-3, 0, 0};
  const BodyId beside = world.add_body(fast);
  world.advance(0.01);
  EXPECT_NEAR(world.state(low).velocity.x(), -3, 1e-6);
  EXPECT_NEAR(world.state(beside).velocity.x(), 0, 1e-6);
}

// What was put somewhere else since does not hang together with what it touched before.
TEST(PlacedTouching, what_is_put_elsewhere_leaves_those_it_touched) {
  World world;
  add_floor_at(world, 0, 0.5);
  const BodyId low = world.add_body(light(make_box({1, 1, 1}), {0, 0, 0.5}));
  const BodyId high = world.add_body(light(make_box({1, 1, 1}), {0, 0, 1.5}));
  world.edit(high, [](StateView& view) { view.set_pose({5, 0, 0.5}, Quat::Identity()); });
  world.advance(1);
  EXPECT_LT((world.state(low).position - Vec3(0, 0, 0.5)).norm(), 1e-9);
  world.edit(high, [](StateView& view) { view.set_pose({0, 0, 1.5}, Quat::Identity()); });
  world.advance(2);
  EXPECT_LT((world.state(high).position - Vec3(0, 0, 1.5)).norm(), 1e-9);
  EXPECT_LT((world.state(low).position - Vec3(0, 0, 0.5)).norm(), 1e-9);
}

TEST(PlacedTouching, has_one_history) {
  std::vector<Schedule> schedules;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 0.005;
    schedules.push_back(schedule);
  }
  const auto struck = [](World& world) {
    add_pyramid(world, 3);
    add_ball(world, 0.4, {-2, 0.1, 1.4}, {8, 0, 1});
  };
  expect_one_history({"a pyramid hit by a ball", 0.4, struck}, schedules, 1);
  // struck at the very first instant, when some have come together and others have not
  const auto struck_at_once = [](World& world) {
    add_pyramid(world, 3);
    add_ball(world, 0.5, {-0.95, 0.1, 1.5}, {40, 0, 0});
    add_ball(world, 0.5, {3.4501, 0, 0.5}, {-40, 0, 0});
  };
  expect_one_history({"a pyramid hit where it was put", 0.1, struck_at_once}, schedules, 1);
}

}  // namespace
}  // namespace tw::test
