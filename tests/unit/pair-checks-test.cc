// Pair checks without a loop: which pairs get a record, and what is forgotten after a rollback.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/pair-checks.h"

#include <gtest/gtest.h>

#include "kernel/loop/active-pairs.h"
#include "support/small-simulation.h"

namespace tw::test {
namespace {

struct PairChecksTest : testing::Test {
  SmallSimulation simulation;
  ActivePairs pairs{simulation.queue};
  PairChecks checks{simulation, pairs};

  void meet(BodyId a, BodyId b) {
    pairs.make_room_for(std::max(a, b));
    std::vector<Meeting> meetings{{a, b, Key{}, 0, false, {}, {}}};
    checks.meet(meetings);
  }
};

TEST_F(PairChecksTest, exact_pair_that_meets_waits_for_its_impact) {
  const BodyId a = simulation.add_ball(0.5, {0, 0, 0}, {1, 0, 0});
  const BodyId b = simulation.add_ball(0.5, {3, 0, 0}, Vec3::Zero());
  meet(b, a);
  const std::uint32_t index = pairs.find(a, b);
  ASSERT_NE(index, ActivePairs::none);
  EXPECT_TRUE(pairs[index].pending);
  EXPECT_EQ(pairs[index].impact, (Key{2, 1, KeyKind::impact, pair_id(a, b)}));
  EXPECT_EQ(simulation.queue.top().key, pairs[index].impact);
}

TEST_F(PairChecksTest, exact_pair_that_never_meets_gets_no_record) {
  const BodyId a = simulation.add_ball(0.5, {0, 0, 0}, {-1, 0, 0});
  const BodyId b = simulation.add_ball(0.5, {3, 0, 0}, Vec3::Zero());
  meet(a, b);
  EXPECT_EQ(pairs.live(), 0u);
  EXPECT_TRUE(simulation.queue.empty());
}

// The later arc, not the one on which the two would have met.
TEST_F(PairChecksTest, impact_is_found_over_as_many_pieces_as_stand) {
  const BodyId a = simulation.add_ball(0.5, {0, 0, 0}, {1, 0, 0});
  const BodyId b = simulation.add_ball(0.5, {3, 0, 0}, Vec3::Zero());
  simulation.turn(a, {1, 1, KeyKind::impact, 9}, {0.5, 0, 0});
  meet(a, b);
  EXPECT_EQ(pairs[pairs.find(a, b)].impact.time, 3);
}

TEST_F(PairChecksTest, impact_before_the_rollback_stays_and_one_after_it_is_forgotten) {
  const BodyId a = simulation.add_ball(0.5, {0, 0, 0}, {1, 0, 0});
  const BodyId b = simulation.add_ball(0.5, {3, 0, 0}, Vec3::Zero());
  meet(a, b);
  const std::uint32_t index = pairs.find(a, b);
  checks.reset(index, {2.5, 1, KeyKind::impact, 0});
  EXPECT_TRUE(pairs[index].pending);

  // a turns away at 1 s
  const Key key{1, 1, KeyKind::impact, 9};
  simulation.turn(a, key, {-1, 0, 0});
  checks.reset(index, key);
  EXPECT_FALSE(pairs[index].pending);
  EXPECT_EQ(pairs[index].from, key);
  EXPECT_EQ(simulation.queue.top().key.time, 1);
  checks.pursue(index);
  EXPECT_EQ(pairs.live(), 0u) << "they never meet now";
}

TEST_F(PairChecksTest, stopped_process_parks_its_pairs) {
  const BodyId a = simulation.add_ball(0.5, {0, 0, 0}, {1, 0, 0});
  const BodyId b = simulation.add_ball(0.5, {3, 0, 0}, Vec3::Zero());
  meet(a, b);
  const Key key{1, 0, KeyKind::callback, 0};
  simulation.turn(a, key, Vec3::Zero());
  simulation.tail(a).error = std::make_exception_ptr(UserError("stop"));
  const std::uint32_t index = pairs.find(a, b);
  checks.reset(index, key);
  checks.pursue(index);
  EXPECT_TRUE(pairs[index].parked);
  EXPECT_TRUE(simulation.queue.empty());
}

}  // namespace
}  // namespace tw::test
