// The event queue against a sorted set.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/event-queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include "base/random.h"

namespace tw::test {
namespace {

Event event_at(double priority, const Key& key, std::uint32_t subject = 0) {
  Event event;
  event.priority = priority;
  event.key = key;
  event.kind = EventKind::pair;
  event.subject = subject;
  return event;
}

// 200 owners of one handle each insert, move and withdraw at random; the top is always the least.
TEST(EventQueue, top_is_the_least_after_any_sequence_of_operations) {
  Random random(1);
  EventQueue queue;
  std::vector<EventQueue::Handle> handles(200, EventQueue::none);
  using Order = std::tuple<double, Key>;
  std::map<std::uint32_t, Order> model;
  for (int step = 0; step < 20000; ++step) {
    const auto owner = static_cast<std::uint32_t>(random.below(handles.size()));
    if (random.below(4) == 0) {
      queue.withdraw(handles[owner]);
      model.erase(owner);
      ASSERT_EQ(handles[owner], EventQueue::none);
    } else {
      // few distinct values: many ties, decided by the key
      const double time = static_cast<double>(random.below(8));
      const double priority = time - 0.5 * static_cast<double>(random.below(4));
      const Key key{time, static_cast<std::uint32_t>(random.below(2)), KeyKind::impact, owner};
      queue.schedule(handles[owner], event_at(priority, key, owner));
      model[owner] = {priority, key};
      ASSERT_EQ(queue.event(handles[owner]).key, key);
    }
    ASSERT_EQ(queue.size(), model.size());
    ASSERT_EQ(queue.empty(), model.empty());
    if (step % 50 == 0) {
      ASSERT_TRUE(queue.validate());
    }
    if (model.empty()) continue;
    const auto least = std::min_element(model.begin(), model.end(), [](auto& a, auto& b) {
      const auto& [pa, ka] = a.second;
      const auto& [pb, kb] = b.second;
      return pa != pb ? pa < pb : ka < kb;
    });
    ASSERT_EQ(queue.top().subject, least->first);

    // the first of an odd owner up to some priority
    const double latest = 0.5 * static_cast<double>(random.below(16));
    const std::uint32_t* expected = nullptr;
    Order first;
    for (const auto& [owner_of, order] : model) {
      if (owner_of % 2 == 0 || std::get<0>(order) > latest || (expected && !(order < first)))
        continue;
      expected = &owner_of;
      first = order;
    }
    const Event* found = queue.first_of(latest, [](const Event& e) { return e.subject % 2 == 1; });
    ASSERT_EQ(found != nullptr, expected != nullptr);
    if (found) {
      ASSERT_EQ(found->subject, *expected);
    }
  }
}

TEST(EventQueue, drains_in_order_of_priority_then_key) {
  Random random(2);
  EventQueue queue;
  std::vector<EventQueue::Handle> handles(3000, EventQueue::none);
  for (std::uint32_t i = 0; i < handles.size(); ++i) {
    const double time = static_cast<double>(random.below(50));
    queue.schedule(handles[i], event_at(time, {time, 0, KeyKind::step, i}, i));
  }
  Key before{-1, 0, KeyKind::birth, 0};
  while (!queue.empty()) {
    EXPECT_LT(before, queue.top().key);
    before = queue.top().key;
    queue.withdraw(handles[queue.top().subject]);
  }
}

TEST(EventQueue, withdrawing_nothing_does_nothing) {
  EventQueue queue;
  EventQueue::Handle handle = EventQueue::none;
  queue.withdraw(handle);
  EXPECT_TRUE(queue.empty());
  queue.schedule(handle, event_at(1, {1, 0, KeyKind::step, 0}));
  queue.withdraw(handle);
  queue.withdraw(handle);
  EXPECT_TRUE(queue.empty());
  EXPECT_TRUE(queue.validate());
}

// Keys: time, then microstep, then kind, then id.
TEST(Keys, compare_by_time_microstep_kind_id) {
  const Key base{1, 1, KeyKind::impact, 5};
  EXPECT_LT(base, (Key{2, 0, KeyKind::birth, 0}));
  EXPECT_LT(base, (Key{1, 2, KeyKind::birth, 0}));
  EXPECT_LT((Key{1, 1, KeyKind::edit, 9}), base);
  EXPECT_LT(base, (Key{1, 1, KeyKind::impact, 6}));
  EXPECT_LE(base, base);
  EXPECT_GE(base, base);
  EXPECT_FALSE(base < base);
  EXPECT_LT(base, last_key);
  // kinds at one instant: a callback sees the state before any impact
  EXPECT_LT((Key{1, 0, KeyKind::callback, 9}), base);
}

TEST(Keys, id_of_a_pair_does_not_depend_on_its_order) {
  EXPECT_EQ(pair_id(3, 17), pair_id(17, 3));
  EXPECT_NE(pair_id(3, 17), pair_id(3, 18));
  EXPECT_LT(pair_id(3, 17), pair_id(4, 5));
  EXPECT_NE(show(Key{1.5, 1, KeyKind::impact, pair_id(17, 3)}).find("impact 3-17 at 1.5 s"),
            std::string::npos);
}

}  // namespace
}  // namespace tw::test
