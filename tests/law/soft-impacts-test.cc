// Soft impacts: what would stay in contact stops the run with a clear message, soon and by name.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

struct Ending {
  std::string message;  // empty: none
  double time = 0;
  std::int64_t collisions = 0, events = 0;
};

Ending run_to(World& world, double until) {
  Ending ending;
  try {
    world.advance(until);
  } catch (const UserError& error) {
    ending.message = error.what();
  }
  ending.time = world.time();
  ending.collisions = count_of(world.statistics(), "collisions");
  ending.events = count_of(world.statistics(), "events");
  return ending;
}

// The message names two of the bodies, the time, and what to do; the run did not grind to it.
void expect_soft(const Ending& ending, const std::vector<std::string>& names, double earliest,
                 double latest) {
  ASSERT_FALSE(ending.message.empty()) << "no error";
  EXPECT_NE(ending.message.find("soft impact of "), std::string::npos) << ending.message;
  int named = 0;
  for (const std::string& name : names) named += ending.message.find(name) != std::string::npos;
  EXPECT_GE(named, 2) << ending.message;
  EXPECT_NE(ending.message.find(" s: "), std::string::npos) << ending.message;
  EXPECT_GE(ending.time, earliest) << ending.message;
  EXPECT_LE(ending.time, latest) << ending.message;
  EXPECT_LT(ending.collisions, 3000);
  EXPECT_LT(ending.events, 100000);
}

BodyId add_named_ball(World& world, const std::string& name, const Vec3& position,
                      const Vec3& velocity = Vec3::Zero()) {
  BodyDef def = body_of(make_sphere(0.5), position, velocity);
  def.name = name;
  return world.add_body(def);
}

void add_floor(World& world) {
  BodyDef def;
  def.name = "floor";
  def.shape = make_half_space(Vec3::UnitZ(), 0);
  def.fixed = true;
  world.add_body(def);
}

TEST(SoftImpacts, ball_that_bounces_ever_lower) {
  for (const double e : {0.3, 0.5, 0.8, 0.95}) {
    World world;
    set_contact_for_all(world, e, 0.3);
    add_floor(world);
    add_named_ball(world, "ball", {0, 0, 2.5});
    // e^n v_0 falls below the fusion speed after n bounces
    const double v0 = std::sqrt(2 * 9.81 * 2), fusion = 0.07 * std::sqrt(9.81 * 1);
    const Ending ending = run_to(world, 100);
    expect_soft(ending, {"ball", "floor"}, v0 / 9.81, 60);
    EXPECT_EQ(ending.collisions, std::ceil(std::log(fusion / v0) / std::log(e))) << e;
  }
}

TEST(SoftImpacts, restitution_zero) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  add_floor(world);
  add_named_ball(world, "ball", {0, 0, 2.5});
  const double fall = std::sqrt(2 * 2 / 9.81);
  expect_soft(run_to(world, 10), {"ball", "floor"}, fall - 1e-9, fall + 1e-9);
}

TEST(SoftImpacts, ball_that_starts_at_rest_on_the_floor) {
  World world;
  set_contact_for_all(world, 0.5, 0.3);
  add_floor(world);
  add_named_ball(world, "ball", {0, 0, 0.5});
  expect_soft(run_to(world, 10), {"ball", "floor"}, 0, 0);
}

TEST(SoftImpacts, box_that_starts_at_rest_on_the_floor) {
  World world;
  set_contact_for_all(world, 0.5, 0.3);
  add_floor(world);
  BodyDef def = body_of(make_box({1, 1, 1}), {0, 0, 0.5}, Vec3::Zero());
  def.name = "box";
  world.add_body(def);
  expect_soft(run_to(world, 10), {"box", "floor"}, 0, 1e-3);
}

TEST(SoftImpacts, columns_of_balls) {
  for (const int count : {2, 3, 5})
    for (const double e : {0.2, 0.5, 0.8}) {
      World world;
      set_contact_for_all(world, e, 0.3);
      add_floor(world);
      std::vector<std::string> names{"floor"};
      for (int i = 0; i < count; ++i) {
        names.push_back("ball-" + std::to_string(i));
        add_named_ball(world, names.back(), {0, 0, 1 + 1.5 * i});
      }
      expect_soft(run_to(world, 100), names, 0.1, 60);
    }
}

TEST(SoftImpacts, ball_squeezed_between_closing_walls) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  std::vector<std::string> names{"ball"};
  for (const double side : {-1.0, 1.0}) {
    BodyDef wall;
    wall.name = side < 0 ? "left" : "right";
    names.push_back(wall.name);
    wall.shape = make_box({1, 4, 4});
    wall.motion = make_keyframes({{0, {side * 2, 0, 0}, {}}, {1, {side * 0.75, 0, 0}, {}}}, false);
    world.add_body(wall);
  }
  add_named_ball(world, "ball", Vec3::Zero(), {1, 0, 0});
  // the gap closes at 0.8 s
  expect_soft(run_to(world, 1), names, 0.5, 0.8);
}

// Three in a row with e = 0.05: intervals and speeds go to 0 in free flight.
TEST(SoftImpacts, inelastic_collapse_in_free_flight) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 0.05, 0);
  add_named_ball(world, "left", {-1.1, 0, 0}, {1, 0, 0});
  add_named_ball(world, "middle", {0, 0, 0}, {0, 0, 0});
  add_named_ball(world, "right", {1.1, 0, 0}, {-1, 0, 0});
  const Ending ending = run_to(world, 10);
  if (!ending.message.empty()) expect_soft(ending, {"left", "middle", "right"}, 0.09, 10);
  EXPECT_LT(ending.collisions, 3000);
}

// The error is the same whatever the schedule, and the balls' motion before it is committed.
TEST(SoftImpacts, message_does_not_depend_on_the_schedule) {
  std::string expected;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    World world;
    apply(world, seed == 0 ? Schedule() : adversary_schedule(seed));
    floor_scene(100).fill(world);
    const Ending ending = run_to(world, 100);
    ASSERT_NE(ending.message.find("soft impact"), std::string::npos);
    if (seed == 0) expected = ending.message;
    EXPECT_EQ(ending.message, expected) << "seed " << seed;
  }
}

// A break shot, a cradle, and a fast ball between two walls are no soft impacts.
TEST(SoftImpacts, fast_elastic_sequences_are_not_soft) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  add_wall(world, Vec3::UnitX(), 0);
  add_wall(world, -Vec3::UnitX(), -2);
  add_named_ball(world, "ball", {1, 0, 0}, {60, 0, 0});  // 1 m to go: every 17 ms
  const Ending ending = run_to(world, 1);
  EXPECT_EQ(ending.message, "");
  EXPECT_EQ(ending.collisions, 60);
  World cradle;
  cradle_scene(100).fill(cradle);
  EXPECT_EQ(run_to(cradle, 100).message, "");
}

// Balls knock about in corners and between neighbours: quick runs of impacts that nothing holds
// together.
TEST(SoftImpacts, dense_elastic_gas_is_not_soft) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  add_walls(world, 0, 3);
  Random random(3);
  for (int k = 0; k < 64; ++k)
    add_ball(world, 0.25, 0.75 * Vec3(k % 4, k / 4 % 4, k / 16) + Vec3::Constant(0.375),
             random_vector(random, 4));
  const Ending ending = run_to(world, long_tests() ? 200 : 20);
  EXPECT_EQ(ending.message, "");
  EXPECT_GT(ending.collisions, 5000);
}

}  // namespace
}  // namespace tw::test
