// Runs that are given up within an arc: nothing has changed, and what follows is what would have.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "base/interruption.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

int asked = 0;

void give_up_now_and_then() {
  if (++asked % 3 == 0) throw Interrupted();
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

TEST(Interruption, within_an_arc_changes_nothing) {
  World whole, broken;
  fill_stack(whole);
  fill_stack(broken);
  whole.advance(1);
  asked = 0;
  int given_up = 0;
  {
    const InterruptionCheck check(give_up_now_and_then);
    for (bool finished = false; !finished;) try {
        broken.advance(1);
        finished = true;
      } catch (const Interrupted&) {
        ++given_up;
      }
  }
  EXPECT_GT(given_up, 10);
  EXPECT_EQ(broken.history_hash(), whole.history_hash());
}

}  // namespace
}  // namespace tw::test
