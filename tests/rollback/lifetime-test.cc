// What is kept of the past: groups and their dense output go with the states that follow them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "groups/group.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// A long run keeps the groups that stand, and a world that goes takes all with it.
TEST(Lifetime, groups_of_the_past_go) {
  const std::int64_t before = Group::alive();
  {
    World world;
    tower_scene(12, 0).fill(world);
    std::int64_t most = 0;
    for (int i = 1; i <= 40; ++i) {
      world.advance(0.05 * i);
      most = std::max(most, Group::alive() - before);
    }
    EXPECT_GT(count_of(world.statistics(), "groups"), 200);
    EXPECT_LE(most, 13);
  }
  EXPECT_EQ(Group::alive(), before);
}

}  // namespace
}  // namespace tw::test
