// Runs that are given up within an arc: nothing has changed, and what follows is what would have.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/interruption.h"
#include "integrate/given/keyframes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

int asked = 0, patience = 3;

// More and more seldom, as what was given up begins again.
void give_up_now_and_then() {
  if (++asked < patience) return;
  asked = 0;
  patience += 1 + patience / 16;
  throw Interrupted();
}

// Cubes and a ball that fall on each other, so closely followed that their arcs take many steps.
void fill_stack(World& world) {
  set_contact_for_all(world, 0.3, 0.5);
  world.set_accuracy(1e-10);
  world.set_hash(true);
  add_wall(world, Vec3::UnitZ(), 0);
  for (int i = 0; i < 3; ++i)
    world.add_body(body_of(make_box({1, 1, 1}), {0.1 * i, 0, 0.6 + 1.1 * i}, Vec3::Zero()));
  add_ball(world, 0.5, {0.2, 0.1, 4.2}, Vec3::Zero());
}

// Small balls in the way of a thin disc that turns over so fast that it is through each of them
// between two points of the grid.
void fill_mower(World& world) {
  set_contact_for_all(world, 0.3, 0.5);
  world.set_hash(true);
  BodyDef disc;
  disc.shape = make_cylinder(2000, 0.02);
  disc.name = "disc";
  const Quat turned(Eigen::AngleAxisd(2, Vec3::UnitX()));
  disc.motion =
      make_keyframes({{0, {0, 0, 0}, Quat::Identity()}, {0.01, {0, 0, 0}, turned}}, false);
  world.add_body(disc);
  for (int i = 0; i < 3; ++i) add_ball(world, 0.05, {10.0 * i, 800.0 + 100 * i, 100}, Vec3::Zero());
}

// How often a run was given up that came to the same history as one that was not.
int given_up_in(void (*fill)(World&), double until, int threads) {
  World whole, broken;
  fill(whole);
  fill(broken);
  whole.advance(until);
  broken.set_threads(threads);
  asked = 0;
  patience = 3;
  int given_up = 0;
  {
    const InterruptionCheck check(give_up_now_and_then);
    for (bool finished = false; !finished;) try {
        broken.advance(until);
        finished = true;
      } catch (const Interrupted&) {
        ++given_up;
      }
  }
  EXPECT_EQ(broken.history_hash(), whole.history_hash());
  return given_up;
}

TEST(Interruption, within_an_arc_changes_nothing) { EXPECT_GT(given_up_in(fill_stack, 1, 1), 5); }

TEST(Interruption, between_grid_points_changes_nothing) {
  for (const int threads : {1, 2}) EXPECT_GT(given_up_in(fill_mower, 0.02, threads), 10);
}

}  // namespace
}  // namespace tw::test
