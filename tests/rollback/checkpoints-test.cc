// Checkpoints made while bodies wait for their first run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tw::test
