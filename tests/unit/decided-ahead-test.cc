// What was decided ahead is there for its event for as long as what it was made of stands.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/decided-ahead.h"

#include <gtest/gtest.h>

namespace tw::test {
namespace {

struct DecidedAheadTest : testing::Test {
  StateGraph graph;
  DecidedAhead ahead;

  std::unique_ptr<Decision> decision(double time, std::initializer_list<ProcessId> read = {}) {
    auto made = std::make_unique<Decision>();
    made->key = key(time);
    for (const ProcessId process : read) made->log.note(*graph.last_before(process, made->key));
    made->log.close();
    return made;
  }
  // One with a state at 0.1 s.
  ProcessId process() {
    const ProcessId made = graph.add_process();
    graph.append(made, key(0.1));
    return made;
  }
  template <class... Made>
  void add(Made... made) {
    std::vector<std::unique_ptr<Decision>> all;
    (all.push_back(std::move(made)), ...);
    ahead.add(std::move(all));
  }
  static Key key(double time) { return {time, 1, KeyKind::impact, 7}; }
};

TEST_F(DecidedAheadTest, each_is_taken_once_by_its_key) {
  add(decision(2), nullptr, decision(1), decision(3));
  EXPECT_TRUE(ahead.has_at(2));
  EXPECT_FALSE(ahead.has_at(2.5));
  EXPECT_FALSE(ahead.take({2, 1, KeyKind::impact, 8}, graph));
  const auto taken = ahead.take(key(2), graph);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->key, key(2));
  EXPECT_FALSE(ahead.take(key(2), graph));
  EXPECT_TRUE(ahead.has_at(1) && ahead.has_at(3));
}

TEST_F(DecidedAheadTest, a_later_decision_of_the_same_key_takes_the_place_of_the_first) {
  const ProcessId read = process();
  add(decision(1, {read}));
  graph.append(read, key(0.5));
  add(decision(1, {read}));
  EXPECT_TRUE(ahead.take(key(1), graph));
  EXPECT_FALSE(ahead.has_at(1));
}

TEST_F(DecidedAheadTest, it_holds_no_more_when_another_state_stands_before_its_key) {
  const ProcessId read = process(), other = process();
  add(decision(1, {read}), decision(2, {other}));
  graph.append(read, key(0.5));
  EXPECT_FALSE(ahead.take(key(1), graph));
  EXPECT_TRUE(ahead.take(key(2), graph));
}

TEST_F(DecidedAheadTest, what_enters_after_its_key_is_nothing_to_it) {
  const ProcessId read = process();
  add(decision(1, {read}));
  graph.append(read, key(1.5));
  EXPECT_TRUE(ahead.take(key(1), graph));
}

TEST_F(DecidedAheadTest, a_state_that_went_and_came_again_is_another_one) {
  const ProcessId read = process();
  graph.append(read, key(0.5));
  add(decision(1, {read}));
  std::vector<Affected> affected;
  graph.rollback(read, key(0.5), affected, [](State&) {});
  graph.append(read, key(0.5));
  EXPECT_FALSE(ahead.take(key(1), graph));
}

TEST_F(DecidedAheadTest, states_that_may_not_be_read_are_refused) {
  const ProcessId one = process(), other = process();
  ReadLog log;
  log.restrict_to([&](const State& state) { return state.process == one; });
  EXPECT_NO_THROW(log.note(*graph.tail(one)));
  EXPECT_THROW(log.note(*graph.tail(other)), ReadLog::Unreadable);
  log.close();
  EXPECT_TRUE(log.holds(graph, key(1)));
}

TEST_F(DecidedAheadTest, what_is_past_is_forgotten) {
  add(decision(1), decision(2), decision(3));
  ahead.forget_before(2);
  EXPECT_FALSE(ahead.has_at(1));
  EXPECT_TRUE(ahead.has_at(2) && ahead.has_at(3));
  ahead.forget();
  EXPECT_FALSE(ahead.has_at(3));
}

}  // namespace
}  // namespace tw::test
