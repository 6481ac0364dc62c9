// The state graph alone: rollback removes exactly the states that are reachable.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "rollback/random-graph.h"

namespace tw::test {
namespace {

std::set<StateName> difference(const std::set<StateName>& a, const std::set<StateName>& b) {
  std::set<StateName> result;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(),
                      std::inserter(result, result.begin()));
  return result;
}

// One rollback against the oracle: who went, who stayed, who was touched and from when.
void check_one_rollback(StateGraph& graph, std::uint32_t process, const Key& key) {
  const std::set<StateName> before = names_in(graph);
  const std::set<StateName> expected = reachable(graph, process, key);
  std::vector<Affected> affected;
  const std::set<StateName> removed = removed_by_rollback(graph, process, key, affected);
  ASSERT_EQ(removed, expected);
  ASSERT_EQ(names_in(graph), difference(before, expected));
  ASSERT_EQ(graph.validate(), "");

  std::map<std::uint32_t, double> least;
  for (const auto& [p, time] : expected)
    least[p] = least.contains(p) ? std::min(least[p], time) : time;
  ASSERT_EQ(affected.size(), least.size());
  for (const Affected& t : affected) ASSERT_EQ(t.least_removed.time, least[number(t.process)]);
}

TEST(StateGraph, rollback_removes_exactly_the_reachable_states) {
  Random random(1);
  const int graphs = 300;
  std::size_t removed = 0;
  for (int g = 0; g < graphs; ++g) {
    StateGraph graph;
    const auto processes = static_cast<std::uint32_t>(1 + random.below(200));
    const int discontinuities = static_cast<int>(1 + random.below(4 * processes));
    fill_randomly(graph, processes, discontinuities, 1 + static_cast<std::uint32_t>(g % 5), random);
    ASSERT_EQ(graph.validate(), "");
    for (int i = 0; i < 4; ++i) {
      const auto process = static_cast<std::uint32_t>(random.below(processes));
      const auto time =
          1 + static_cast<double>(random.below(static_cast<std::uint64_t>(discontinuities)));
      const std::size_t before = graph.state_count();
      check_one_rollback(graph, process, impact_at(time));
      if (HasFatalFailure()) FAIL() << "graph " << g;
      removed += before - graph.state_count();
    }
  }
  EXPECT_GT(removed, 10000u);
}

// Queues that lost their ends grow again; the pool's old states leave no trace.
TEST(StateGraph, rollback_and_growth_alternate) {
  Random random(2);
  StateGraph graph;
  const std::uint32_t processes = 60;
  fill_randomly(graph, processes, 100, 3, random);
  double now = 101;
  for (int round = 0; round < 500; ++round) {
    for (int i = 0; i < 5; ++i, ++now) {
      const auto a = static_cast<std::uint32_t>(random.below(processes));
      const auto b = static_cast<std::uint32_t>((a + 1 + random.below(processes - 1)) % processes);
      append_ring(graph, {a, b}, impact_at(now));
    }
    const auto process = static_cast<std::uint32_t>(random.below(processes));
    check_one_rollback(graph, process, impact_at(now - static_cast<double>(random.below(25))));
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

TEST(StateGraph, rollback_of_nothing_touches_nobody) {
  Random random(3);
  StateGraph graph;
  fill_randomly(graph, 10, 20, 2, random);
  std::vector<Affected> affected;
  const std::set<StateName> before = names_in(graph);
  EXPECT_TRUE(removed_by_rollback(graph, 4, impact_at(1000), affected).empty());
  EXPECT_TRUE(affected.empty());
  EXPECT_EQ(names_in(graph), before);
}

// A chain of 20,000 links: a work list, not the call stack.
TEST(StateGraph, rollback_follows_very_long_chains) {
  StateGraph graph;
  const std::uint32_t processes = 20000;
  for (std::uint32_t p = 0; p < processes; ++p) {
    graph.add_process();
    graph.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
  }
  for (std::uint32_t p = 0; p + 1 < processes; ++p)
    append_ring(graph, {p, p + 1}, impact_at(1 + p));
  std::vector<Affected> affected;
  // process 1 has the impacts at 1 (with 0) and 2 (with 2): all later ones follow
  std::size_t removed = 0;
  removed = graph.rollback(ProcessId{1}, impact_at(2), affected, [](State&) {});
  EXPECT_EQ(removed, 2u * (processes - 2));
  EXPECT_EQ(graph.tail(ProcessId{0})->key, impact_at(1));
  EXPECT_EQ(graph.tail(ProcessId{1})->key, impact_at(1));
}

// Keys decide, not times: of two impacts at one instant the later key goes alone.
TEST(StateGraph, rollback_is_to_a_key_within_one_instant) {
  StateGraph graph;
  for (std::uint32_t p = 0; p < 3; ++p) {
    graph.add_process();
    graph.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
  }
  const Key first{1, 1, KeyKind::impact, pair_id(0, 1)},
      second{1, 2, KeyKind::impact, pair_id(1, 2)};
  append_ring(graph, {0, 1}, first);
  append_ring(graph, {1, 2}, second);
  std::vector<Affected> affected;
  EXPECT_EQ(graph.rollback(ProcessId{1}, second, affected, [](State&) {}), 2u);
  EXPECT_EQ(graph.tail(ProcessId{1})->key, first);
  EXPECT_EQ(graph.tail(ProcessId{0})->key, first);
  EXPECT_EQ(graph.tail(ProcessId{2})->key.time, 0);
}

// Figure 3 of the paper: five bodies, the states of each collision tied together, and a collision
// of a and b that is found late.  a stands at its latest state; b is ahead and loses its states,
// whose rings lead to c, d and e: "all states that were possibly affected by the collision - and no
// others - are deleted".  Crossed out are the states in brackets.
//
//   a  0 ---- 1 -------- new
//   b  0 ---- 1 -------- new [3] ------------- [6]      rings: 1 a-b   2 d-e   3 b-c
//   c  0 ------------------- [3] -- [4] ------ [6]             4 c-d   5 d-e   6 b-c
//   d  0 --------- 2 -------------- [4] - [5]
//   e  0 --------- 2 -------------------- [5]
class Figure3 : public testing::Test {
 protected:
  enum : std::uint32_t { a, b, c, d, e };
  using Names = std::set<StateName>;

  void SetUp() override {
    for (std::uint32_t p = a; p <= e; ++p) {
      graph_.add_process();
      graph_.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
    }
    append_ring(graph_, {a, b}, impact_at(1));
    append_ring(graph_, {d, e}, impact_at(2));
    append_ring(graph_, {b, c}, impact_at(3));
    append_ring(graph_, {c, d}, impact_at(4));
    append_ring(graph_, {d, e}, impact_at(5));
    append_ring(graph_, {b, c}, impact_at(6));
  }
  Names removed(std::uint32_t process, double time) {
    std::vector<Affected> affected;
    const Names names = removed_by_rollback(graph_, process, impact_at(time), affected);
    EXPECT_EQ(graph_.validate(), "");
    return names;
  }

  StateGraph graph_;
};

TEST_F(Figure3, late_collision_deletes_exactly_the_crossed_out_states) {
  EXPECT_EQ(removed(a, 2.5), Names{});
  EXPECT_EQ(removed(b, 2.5),
            (Names{{b, 3}, {c, 3}, {c, 4}, {d, 4}, {d, 5}, {e, 5}, {b, 6}, {c, 6}}));
  append_ring(graph_, {a, b}, impact_at(2.5));
  EXPECT_EQ(graph_.validate(), "");
  EXPECT_EQ(names_in(graph_), (Names{{a, 0},
                                     {a, 1},
                                     {a, 2.5},
                                     {b, 0},
                                     {b, 1},
                                     {b, 2.5},
                                     {c, 0},
                                     {d, 0},
                                     {d, 2},
                                     {e, 0},
                                     {e, 2}}));
}

TEST_F(Figure3, rollback_of_the_latest_collision_deletes_its_two_states) {
  EXPECT_EQ(removed(c, 5.5), (Names{{b, 6}, {c, 6}}));
}

TEST_F(Figure3, rollback_that_starts_at_the_other_end_follows_the_rings_back) {
  EXPECT_EQ(removed(e, 4.5), (Names{{e, 5}, {d, 5}}));
  EXPECT_EQ(removed(d, 3.5), (Names{{d, 4}, {c, 4}, {c, 6}, {b, 6}}));
}

TEST(StateGraph, look_up_by_key_and_time_takes_the_last_state) {
  StateGraph graph;
  graph.add_process();
  graph.append(ProcessId{0}, {0, 0, KeyKind::birth, 0});
  const Key first{1, 1, KeyKind::impact, 1}, second{1, 2, KeyKind::impact, 2};
  graph.append(ProcessId{0}, first);
  graph.append(ProcessId{0}, second);
  graph.append(ProcessId{0}, impact_at(2));
  EXPECT_EQ(graph.last_at_or_before(ProcessId{0}, first)->key, first);
  EXPECT_EQ(graph.last_before(ProcessId{0}, first)->key.time, 0);
  EXPECT_EQ(graph.last_before(ProcessId{0}, second)->key, first);
  // at the time of a discontinuity: what follows it
  EXPECT_EQ(graph.last_at_or_before_time(ProcessId{0}, 1)->key, second);
  EXPECT_EQ(graph.last_at_or_before_time(ProcessId{0}, std::nextafter(1.0, 0.0))->key.time, 0);
  EXPECT_EQ(graph.last_before(ProcessId{0}, {0, 0, KeyKind::birth, 0}), nullptr);
}

TEST(StateGraph, look_up_among_the_first_states_sees_none_that_entered_later) {
  StateGraph graph;
  const ProcessId process = graph.add_process(), other = graph.add_process();
  State* const first = graph.append(process, {1, 1, KeyKind::impact, 0});
  graph.append(other, {1, 1, KeyKind::impact, 0});
  const std::uint64_t then = graph.entered();
  State* const second = graph.append(process, {2, 1, KeyKind::impact, 0});
  EXPECT_EQ(graph.entered(), then + 1);
  const Key later{3, 1, KeyKind::impact, 0};
  EXPECT_EQ(graph.last_before(process, later), second);
  EXPECT_EQ(graph.last_before(process, later, then), first);
  EXPECT_EQ(graph.last_before(process, later, graph.entered()), second);
  EXPECT_EQ(graph.last_before(process, first->key, then), nullptr);
}

TEST(StateGraph, who_looks_is_waited_for_before_a_state_goes_and_not_otherwise) {
  StateGraph graph;
  int waits = 0;
  std::size_t states_then = 0;
  graph.before_removal([&] {
    ++waits;
    states_then = graph.state_count();
  });
  const ProcessId process = graph.add_process();
  State* last = nullptr;
  for (const double time : {1.0, 2.0, 3.0})
    last = graph.append(process, {time, 1, KeyKind::impact, 0});
  const StateGraph::OnRelease nothing = [](State&) {};
  std::vector<Affected> affected;
  EXPECT_EQ(graph.rollback(process, {4, 1, KeyKind::impact, 0}, affected, nothing), 0u);
  EXPECT_EQ(waits, 0);
  EXPECT_EQ(graph.rollback(process, last->key, affected, nothing), 1u);
  EXPECT_EQ(waits, 1);
  EXPECT_EQ(states_then, 3u);
  for (const int expected : {2, 2}) {
    graph.free_before(graph.tail(process), nothing);
    EXPECT_EQ(waits, expected);
  }
  EXPECT_EQ(graph.state_count(), 1u);
}

TEST(StateGraph, freeing_the_past_leaves_the_rest_valid) {
  Random random(5);
  StateGraph graph;
  const std::uint32_t processes = 40;
  fill_randomly(graph, processes, 400, 3, random);
  for (std::uint32_t p = 0; p < processes; ++p) {
    State* keep = graph.last_at_or_before_time(ProcessId{p}, 200);
    for (State* s = graph.head(ProcessId{p}); s; s = s->next) s->committed = s->key.time <= 200;
    graph.free_before(keep, [](State&) {});
    EXPECT_EQ(graph.head(ProcessId{p}), keep);
  }
  EXPECT_EQ(graph.validate(), "");
  check_one_rollback(graph, 7, impact_at(201));
}

// The always-on invariants, which stop the program with a message.
TEST(StateGraphDeathTest, rollback_never_reaches_a_committed_state) {
  StateGraph graph;
  for (std::uint32_t p = 0; p < 2; ++p) {
    graph.add_process();
    graph.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
  }
  for (State* s : append_ring(graph, {0, 1}, impact_at(1))) s->committed = true;
  append_ring(graph, {0, 1}, impact_at(2));
  std::vector<Affected> affected;
  EXPECT_DEATH(graph.rollback(ProcessId{0}, impact_at(0.5), affected, [](State&) {}),
               "rollback of process 0 .* reached the committed");
}

TEST(StateGraphDeathTest, keys_in_a_queue_increase) {
  StateGraph graph;
  graph.add_process();
  graph.append(ProcessId{0}, impact_at(2));
  EXPECT_DEATH(graph.append(ProcessId{0}, impact_at(1)), "must increase");
  EXPECT_DEATH(graph.append(ProcessId{0}, impact_at(2)), "must increase");
}

// The validator finds what it is there for.
TEST(StateGraph, validator_names_a_broken_ring) {
  StateGraph graph;
  for (std::uint32_t p = 0; p < 2; ++p) {
    graph.add_process();
    graph.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
  }
  State* one = graph.append(ProcessId{0}, impact_at(1));
  State* two = graph.append(ProcessId{1}, impact_at(2));
  State* ring[] = {one, two};
  graph.close_ring(ring);
  EXPECT_NE(graph.validate().find("ring of two keys"), std::string::npos);
}

}  // namespace
}  // namespace tw::test
