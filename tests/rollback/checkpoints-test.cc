// Checkpoints: made while bodies wait for their first run; across bodies that come and go.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "rollback/kernel-access.h"
#include "support/counter.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// A fixed body has no box before its first claim, and claims at the beginning of a run: one that
// came just before the checkpoint is one that came, after the restore, too.
TEST(Checkpoints, body_added_before_one_is_met_after_the_restore) {
  World world;
  const BodyId ball = add_ball(world, 0.1, {0, 0, 3}, Vec3::Zero());
  world.advance(0.2);
  BodyDef block = body_of(make_box({1, 1, 1}), Vec3::Zero(), Vec3::Zero());
  block.fixed = true;
  world.add_body(block);
  const auto checkpoint = world.checkpoint();
  for (int time = 0; time < 2; ++time) {
    world.restore(*checkpoint);
    world.advance(2);
    EXPECT_GT(world.state(ball).position.z(), 0.5) << "it fell through";
    EXPECT_GT(count_of(world.statistics(), "collisions"), 0);
  }
}

// What is refused at the beginning of a run is refused after a restore.
TEST(Checkpoints, overlap_of_a_new_body_is_found_after_the_restore) {
  World world;
  add_ball(world, 0.5, {0, 0, 3}, Vec3::Zero());
  world.advance(0.1);
  add_ball(world, 0.5, {0, 0, 3}, Vec3::Zero());
  const auto checkpoint = world.checkpoint();
  world.restore(*checkpoint);
  EXPECT_THROW(world.advance(1), UserError);
}

// A ball that was thrown into a lattice, one that was taken out of it, and both undone, in either
// order, leave no trace; under any schedule.
TEST(Checkpoints, who_came_is_gone_and_who_went_is_back) {
  const Scene scene = lattice_scene(3, 1.1, 2);
  const std::string expected = run(scene, Schedule()).hash;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    World world;
    apply(world, seed ? adversary_schedule(seed) : Schedule());
    scene.fill(world);
    world.advance(0.6);
    const std::uint64_t serial = world.serial(12);
    const auto before = world.checkpoint();
    const Vec3 there = world.state(12).position;
    world.remove_body(12);
    const BodyId ball = add_ball(world, 0.1, there, {0, 0, 9});
    const std::uint64_t serial_of_ball = world.serial(ball);
    world.advance(0.8);
    const auto after = world.checkpoint();
    world.restore(*before);
    EXPECT_EQ(world.body_count(), ball);
    EXPECT_EQ(world.serial(12), serial);
    EXPECT_FALSE(world.body(12).removed);
    world.advance(0.9);
    world.restore(*after);
    EXPECT_EQ(world.serial(ball), serial_of_ball);
    EXPECT_TRUE(world.body(12).removed);
    world.advance(1);
    world.restore(*before);
    EXPECT_EQ(KernelTest(world).validate_event_queue(), "");
    EXPECT_EQ(validate_residences(world.kernel().simulation), "");
    const BodyId other = add_ball(world, 0.2, {0, 0, 9}, Vec3::Zero());
    EXPECT_EQ(other, ball);
    EXPECT_NE(world.serial(other), serial_of_ball);
    world.restore(*before);
    world.advance(scene.duration);
    EXPECT_EQ(world.history_hash(), expected) << "seed " << seed;
  }
}

// An edit that is refused, and takes its place back, leaves no trace; nor does one of nothing.
TEST(Checkpoints, refused_edits_and_edits_of_nothing_leave_no_trace) {
  const Scene scene = heap_scene(8, 1.2);
  const std::string expected = run(scene, Schedule()).hash;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    World world;
    apply(world, seed ? adversary_schedule(seed) : Schedule());
    scene.fill(world);
    for (const double when : {0.3, 0.55, 0.9}) {
      world.advance(when);
      const auto bodies = static_cast<BodyId>(world.body_count());
      for (BodyId id = 0; id < bodies; ++id) {
        if (world.body(id).kind != BodyKind::dynamic) continue;
        // far below the ground
        EXPECT_THROW(world.edit(id,
                                [](StateView& view) {
                                  view.set_pose({0, 0, -50}, Quat::Identity());
                                }),
                     UserError);
        world.edit(id, [](StateView& view) {
          view.set_velocity(view.state().velocity);
          view.set_angular_velocity(view.state().angular_velocity);
          view.set_applied_force(view.applied_force());
          view.set_pose(view.state().position, view.state().orientation);
        });
      }
      world.set_gravity(world.gravity());
      world.set_contact({}, {}, {});
      EXPECT_EQ(KernelTest(world).validate_event_queue(), "");
    }
    world.advance(scene.duration);
    EXPECT_EQ(world.history_hash(), expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tw::test
