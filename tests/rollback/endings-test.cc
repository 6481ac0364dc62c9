// Runs end where they should, and what does not happen costs nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/counter.h"
#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

std::int64_t events_of(const World& world) { return count_of(world.statistics(), "events"); }

// Two bodies that fly apart for ever: their next check lies infinitely far, which holds up nobody.
TEST(Endings, bodies_that_fly_apart_for_ever_do_not_hold_up_the_run) {
  const ShapePtr shapes[] = {make_sphere(0.25), make_box({0.5, 0.5, 0.5}), molecule_shape(),
                             rock_shape(1)};
  for (const ShapePtr& a : shapes)
    for (const ShapePtr& b : shapes) {
      World world;
      world.set_gravity(Vec3::Zero());
      set_contact_for_all(world, 1, 0);
      world.add_body(body_of(a, {-1, 0, 0}, {1, 0, 0}, {1, 2, 3}));
      world.add_body(body_of(b, {1, 0, 0}, {-1, 0, 0}, {-1, 0, 1}));
      world.advance(3);
      EXPECT_GE(count_of(world.statistics(), "collisions"), 1);
      world.advance(100);
      EXPECT_EQ(world.time(), 100);
      EXPECT_LT(events_of(world), 5000) << a->kind_name() << " and " << b->kind_name();
    }
}

// A body alone in the world: a handful of windows, whatever it does.
TEST(Endings, lone_body_costs_next_to_nothing) {
  World world;
  world.add_body(body_of(make_box({1, 2, 3}), Vec3::Zero(), {30, 0, 40}, {1, 2, 3}));
  world.advance(1000);
  EXPECT_LT(events_of(world), 2000);
}

// Boxes that touch, at rest and sliding: no approach, no impact, few checks.
TEST(Endings, bodies_at_touch_that_do_not_approach_are_not_checked_all_the_time) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0.5);
  const ShapePtr cube = make_box({1, 1, 1});
  for (int i = 0; i < 5; ++i) world.add_body(body_of(cube, Vec3(i, 0, 0), Vec3::Zero()));
  // and one that slides along the row
  world.add_body(body_of(cube, {-3, 1, 0}, {2, 0, 0}));
  world.advance(5);
  EXPECT_EQ(count_of(world.statistics(), "collisions"), 0);
  EXPECT_LT(count_of(world.statistics(), "checks"), 5000);
}

// A callback that doubles a velocity again and again: an error with the body's name, soon.
TEST(Endings, runaway_speed_is_an_error_with_the_name) {
  World world;
  world.set_gravity(Vec3::Zero());
  BodyDef def = body_of(make_sphere(1), Vec3::Zero(), {1, 0, 0});
  def.name = "rocket";
  const BodyId rocket = world.add_body(def);
  add_callback(world, {rocket}, 0.01, 0.01, [](double, std::span<StateView* const> targets) {
    targets[0]->set_velocity(2 * targets[0]->state().velocity);
    return std::nullopt;
  });
  try {
    world.advance(100);
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("rocket"), std::string::npos) << error.what();
  }
  EXPECT_LT(world.time(), 1);
  EXPECT_LT(events_of(world), 100000);
}

// A run to the present, or to the past, is over at once and changes nothing.
TEST(Endings, run_to_the_present_or_the_past_is_over_at_once) {
  World world;
  world.set_hash(true);
  lattice_scene(3, 1.1, 1).fill(world);
  world.advance(1);
  const std::string hash = world.history_hash();
  EXPECT_EQ(world.advance(1), RunStatus::finished);
  EXPECT_EQ(world.advance(0.5), RunStatus::finished);
  EXPECT_EQ(world.time(), 1);
  EXPECT_EQ(world.history_hash(), hash);
  EXPECT_THROW(world.advance(std::nan("")), UserError);
  EXPECT_THROW(world.advance(HUGE_VAL), UserError);
}

// An empty world, and one with nothing but walls.
TEST(Endings, worlds_without_moving_bodies_run) {
  World world;
  world.advance(5);
  EXPECT_EQ(world.time(), 5);
  add_walls(world, 0, 1);
  world.advance(10);
  EXPECT_EQ(world.time(), 10);
}

}  // namespace
}  // namespace tw::test
