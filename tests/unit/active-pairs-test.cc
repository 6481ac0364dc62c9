// The table of active pairs against a map of pairs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/active-pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/random.h"

namespace tw::test {
namespace {

struct Pairs : ActivePairs {
  explicit Pairs(EventQueue& queue) : ActivePairs(queue) { make_room_for(19); }
};

TEST(ActivePairs, what_is_made_is_found_from_both_sides_until_it_is_dropped) {
  EventQueue queue;
  Pairs pairs(queue);
  EXPECT_EQ(pairs.find(3, 7), ActivePairs::none);
  EXPECT_TRUE(pairs.of(7).empty());
  const std::uint32_t index = pairs.make(7, 3, {1, 0, KeyKind::birth, 0});
  EXPECT_EQ(pairs[index].a, 3u);
  EXPECT_EQ(pairs[index].b, 7u);
  EXPECT_EQ(pairs[index].safe_time(), 1);
  EXPECT_EQ(pairs.find(3, 7), index);
  EXPECT_EQ(pairs.find(7, 3), index);
  EXPECT_EQ(pairs.live(), 1u);
  pairs.drop(index);
  EXPECT_EQ(pairs.find(3, 7), ActivePairs::none);
  EXPECT_EQ(pairs.live(), 0u);
}

TEST(ActivePairs, dropping_withdraws_the_event) {
  EventQueue queue;
  Pairs pairs(queue);
  const std::uint32_t index = pairs.make(0, 1, {});
  queue.schedule(pairs[index].event, {2, {2, 0, KeyKind::step, 1}, EventKind::pair, index});
  pairs.drop(index);
  EXPECT_TRUE(queue.empty());
}

// Thousands of pairs made and dropped in any order: the lists of bodies hold those that stand, each
// at the place that its record names, and records are used again.
TEST(ActivePairs, lists_and_records_agree_after_any_history) {
  EventQueue queue;
  Pairs pairs(queue);
  std::map<std::pair<BodyId, BodyId>, std::uint32_t> standing;
  Random random(3);
  std::size_t most = 0;
  for (int step = 0; step < 4000; ++step) {
    const auto a = static_cast<BodyId>(random.below(20)), b = static_cast<BodyId>(random.below(20));
    if (a == b) continue;
    const std::pair<BodyId, BodyId> key{std::min(a, b), std::max(a, b)};
    if (const auto known = standing.find(key); known != standing.end()) {
      pairs.drop(known->second);
      standing.erase(known);
    } else {
      standing[key] = pairs.make(a, b, {});
    }
    most = std::max(most, standing.size());
  }
  ASSERT_GT(most, 50u);
  EXPECT_EQ(pairs.size(), most) << "records were not used again";
  EXPECT_EQ(pairs.live(), standing.size());
  std::size_t listed = 0;
  for (BodyId body = 0; body < 20; ++body) listed += pairs.of(body).size();
  EXPECT_EQ(listed, 2 * standing.size());
  for (const auto& [key, index] : standing) {
    EXPECT_EQ(pairs.find(key.second, key.first), index);
    EXPECT_EQ(pairs.of(key.first)[pairs[index].place_a], index);
    EXPECT_EQ(pairs.of(key.second)[pairs[index].place_b], index);
  }

  pairs.drop_all_of(5);
  EXPECT_TRUE(pairs.of(5).empty());
  for (BodyId other = 0; other < 20; ++other) EXPECT_EQ(pairs.find(5, other), ActivePairs::none);
  pairs.drop_all();
  EXPECT_EQ(pairs.live(), 0u);
}

}  // namespace
}  // namespace tw::test
