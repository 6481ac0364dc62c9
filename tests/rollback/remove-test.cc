// Bodies removed between runs: what lay on them falls, nothing else changes, no schedule matters.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "rollback/kernel-access.h"
#include "support/callback-scenes.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

struct Stack {
  explicit Stack(const Schedule& schedule = Schedule()) {
    apply(world, schedule);
    set_contact_for_all(world, 0.2, 0.5);
    floor = add_block(world, {10, 10, 1}, {0, 0, -0.5});
    for (int i = 0; i < 3; ++i)
      boxes.push_back(add_box(world, {0.4, 0.4, 0.2}, {0.01 * i, 0, 0.1 + 0.2 * i}));
  }
  World world;
  BodyId floor = 0;
  std::vector<BodyId> boxes;
};

double height(const World& world, BodyId id) { return world.state(id).position.z(); }

TEST(Remove, what_lay_on_a_body_falls_on_what_is_below) {
  for (const double when : {0.0, 0.1, 2.0}) {
    Stack scene;
    scene.world.set_check(true);
    if (when > 0) scene.world.advance(when);
    scene.world.remove_body(scene.boxes[1]);
    EXPECT_EQ(validate_state_graph(scene.world.kernel().simulation), "");
    scene.world.advance(when + 2);
    EXPECT_NEAR(height(scene.world, scene.boxes[2]), 0.3, 2e-3) << "removed at " << when;
    EXPECT_NEAR(height(scene.world, scene.boxes[0]), 0.1, 1e-3);
    EXPECT_EQ(count_of(scene.world.statistics(), "bodies_total"), 3);
    EXPECT_EQ(count_of(scene.world.statistics(), "bodies_moving"), 2);
  }
}

TEST(Remove, what_lay_on_the_floor_falls_for_ever) {
  for (const bool half_space : {false, true}) {
    World world;
    const BodyId floor =
        half_space ? add_wall(world, Vec3::UnitZ(), 0) : add_block(world, {4, 4, 1}, {0, 0, -0.5});
    const BodyId box = add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.1});
    world.advance(2);
    ASSERT_NEAR(height(world, box), 0.1, 1e-3);
    world.remove_body(floor);
    const double z = height(world, box);
    world.advance(3);
    EXPECT_NEAR(height(world, box), z - 0.5 * 9.81, 1e-9);
  }
}

TEST(Remove, no_schedule_changes_what_follows) {
  std::string expected;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    World world;
    apply(world, seed ? adversary_schedule(seed) : Schedule());
    lattice_scene(3, 1.1, 2).fill(world);
    world.advance(0.7);
    world.remove_body(12);
    world.remove_body(25);
    world.advance(2);
    if (seed == 0) expected = world.history_hash();
    EXPECT_EQ(world.history_hash(), expected) << "seed " << seed;
  }
}

TEST(Remove, callbacks_on_it_end_and_its_name_is_free) {
  Stack scene;
  int calls = 0;
  add_callback(
      scene.world, {scene.boxes[2], scene.boxes[0]}, 0.1, 0.1,
      [&](double, std::span<StateView* const>) { return ++calls, std::optional<double>(); });
  scene.world.advance(0.35);
  EXPECT_EQ(calls, 3);
  const std::string name = scene.world.body(scene.boxes[2]).name;
  const auto checkpoint = scene.world.checkpoint();
  scene.world.remove_body(scene.boxes[2]);
  EXPECT_THROW(scene.world.remove_body(scene.boxes[2]), UserError);
  EXPECT_FALSE(scene.world.find_body(name));
  BodyDef again = body_of(make_sphere(0.1), {2, 0, 0.1}, Vec3::Zero());
  again.name = name;
  EXPECT_NO_THROW(scene.world.add_body(again));
  scene.world.advance(1);
  EXPECT_EQ(calls, 3);
  scene.world.restore(*checkpoint);
  EXPECT_EQ(scene.world.find_body(name), scene.boxes[2]);
  scene.world.advance(0.55);
  EXPECT_EQ(calls, 5);
}

// Balls that come and go: no room is kept for those that are gone but their numbers.
TEST(Remove, a_fountain_runs_on) {
  World world;
  set_contact_for_all(world, 0.5, 0.2);
  add_wall(world, Vec3::UnitZ(), 0);
  std::vector<BodyId> balls;
  for (int i = 0; i < 60; ++i) {
    balls.push_back(add_ball(world, 0.1, {0, 0, 0.5}, {1 + 0.01 * i, 0.5, 4}));
    world.advance(0.2 * (i + 1));
    if (i >= 10) world.remove_body(balls[static_cast<std::size_t>(i - 10)]);
  }
  EXPECT_EQ(count_of(world.statistics(), "bodies_total"), 11);
  EXPECT_LE(world.kernel().pairs.size(), 60u);
}

}  // namespace
}  // namespace tw::test
