// What is kept of the past: groups and their dense output go with the states that follow them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "groups/group.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

// A long run keeps the groups that stand, and a world that goes takes all with it.
TEST(Lifetime, groups_of_the_past_go) {
  const std::int64_t before = Group::alive();
  for (const int threads : {1, 2}) {
    World world;
    world.set_threads(threads);
    tower_scene(12, 0).fill(world);
    std::int64_t most = 0;
    for (int i = 1; i <= 80; ++i) {
      world.advance(0.05 * i);
      most = std::max(most, Group::alive() - before);
    }
    EXPECT_GT(count_of(world.statistics(), "groups"), 200);
    EXPECT_LE(most, 13);  // one of each body and one more
  }
  EXPECT_EQ(Group::alive(), before);
}

// Heaps in which balls and drums roll on, so that groups follow each other without end: never do
// more of them stand than there are bodies, and each has one arc.  They grow in number as the heap
// falls apart into groups of few, from 10 to 14.
TEST(Lifetime, groups_stay_few_in_a_heap_that_never_rests) {
  const std::int64_t groups = Group::alive(), arcs = GroupArc::alive();
  for (const std::uint64_t seed : {1, 2}) {
    World world;
    heap_scene(20, seed, true, 0.2, 0).fill(world);
    for (int i = 1; i <= 200; ++i) {
      world.advance(0.1 * i);
      const std::int64_t now = Group::alive() - groups;
      ASSERT_LE(now, 20) << seed << " at " << world.time();
      EXPECT_EQ(GroupArc::alive() - arcs, now);
    }
    EXPECT_GT(count_of(world.statistics(), "groups"), 1000);
  }
  EXPECT_EQ(Group::alive(), groups);
  EXPECT_EQ(GroupArc::alive(), arcs);
}

}  // namespace
}  // namespace tw::test
