// The book of callbacks without a loop: ticks, rollbacks, checkpoints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/callback-book.h"

#include <gtest/gtest.h>

#include "support/small-simulation.h"

namespace tw::test {
namespace {

struct CallbackBookTest : testing::Test {
  SmallSimulation simulation;
  CallbackBook book{simulation};
  BodyId ball = simulation.add_ball(0.5, Vec3::Zero(), Vec3::Zero());

  std::uint32_t add(double start, std::optional<double> period) {
    CallbackDef def;
    def.targets = {ball};
    def.start = start;
    def.period = period;
    return book.add(def);
  }
  // The record that a call leaves on its target.
  State& leave_record(std::uint32_t number, double next) {
    State& state = *simulation.graph.append(simulation.process_of(ball), book[number].next);
    state.next_callback = next;
    book.move_on(number, next);
    return state;
  }
  double next(std::uint32_t number) const { return book[number].next.time; }
};

TEST_F(CallbackBookTest, ticks_are_start_and_multiples_of_the_period) {
  const std::uint32_t number = add(0.1, 0.1);
  for (int k = 0; k < 30; ++k) {
    EXPECT_EQ(next(number), 0.1 + k * 0.1);
    EXPECT_EQ(simulation.queue.top().key, book[number].next);
    book.move_on(number, never);
  }
}

TEST_F(CallbackBookTest, ticks_before_the_present_are_not_made_up_for) {
  simulation.present.time = 1;
  simulation.present.begun = true;
  EXPECT_EQ(next(add(0, 0.3)), 0 + 4 * 0.3);
  // a tick at the present time has passed where the run went as far as that, and not where an error
  // stopped it there
  EXPECT_EQ(next(add(0.5, 0.5)), 1);
  simulation.present.due.inclusive = true;
  EXPECT_EQ(next(add(0.5, 0.5)), 1.5);
}

TEST_F(CallbackBookTest, rewound_to_the_first_call_that_does_not_stand) {
  const std::uint32_t number = add(0.5, 0.5);
  for (int k = 0; k < 4; ++k) leave_record(number, never);
  EXPECT_EQ(next(number), 2.5);
  std::vector<Affected> affected;
  const Key key{1.2, 1, KeyKind::impact, 0};
  simulation.graph.rollback(simulation.process_of(ball), key, affected, [](State&) {});
  book.rewind(number, key);
  EXPECT_EQ(next(number), 1.5);
  // one that stands at the key is not made twice
  book.rewind(number, {1, 0, KeyKind::callback, number});
  EXPECT_EQ(next(number), 1.5);
}

TEST_F(CallbackBookTest, without_a_period_the_last_record_that_is_left_says_when) {
  const std::uint32_t number = add(0.5, std::nullopt);
  leave_record(number, 0.8);
  leave_record(number, 2);
  EXPECT_EQ(next(number), 2);
  std::vector<Affected> affected;
  const Key key{0.7, 1, KeyKind::impact, 0};
  simulation.graph.rollback(simulation.process_of(ball), key, affected, [](State&) {});
  book.rewind(number, key);
  EXPECT_EQ(next(number), 0.8);
  // no record is left: the committed next time
  simulation.graph.rollback(simulation.process_of(ball), {0.2, 0, KeyKind::birth, 0}, affected,
                            [](State&) {});
  book.rewind(number, {0.2, 0, KeyKind::birth, 0});
  EXPECT_EQ(next(number), 0.5);
}

TEST_F(CallbackBookTest, parked_until_a_rollback_and_ended_for_good) {
  const std::uint32_t number = add(0.5, 0.5);
  book.park(number);
  EXPECT_TRUE(simulation.queue.empty());
  book.rewind(number, {0.2, 0, KeyKind::birth, 0});
  EXPECT_EQ(simulation.queue.top().key.time, 0.5);
  book.end_all_of(ball);
  EXPECT_TRUE(simulation.queue.empty());
  book.rewind(number, {0.2, 0, KeyKind::birth, 0});
  EXPECT_TRUE(simulation.queue.empty());
}

TEST_F(CallbackBookTest, committed_ticks_bring_back_what_comes_next) {
  const BodyId fellow = simulation.add_ball(0.5, Vec3(3, 0, 0), Vec3::Zero());
  const std::uint32_t steady = add(0.5, 0.5), free = add(0.25, std::nullopt);
  simulation.present.begun = true;
  simulation.present.time = 1;
  simulation.present.due = {1, true};
  // a fellow of the target's group that was drawn in knows no next time
  const State& drawn_in = *simulation.graph.append(simulation.process_of(fellow), book[free].next);
  book.note_committed(leave_record(free, 1.75));
  book.note_committed(drawn_in);
  const auto ticks = book.keep();
  for (int k = 0; k < 5; ++k) book.move_on(steady, never);
  book.move_on(free, 9);
  book.restore(ticks);
  EXPECT_EQ(next(steady), 1.5);
  EXPECT_EQ(next(free), 1.75);
}

}  // namespace
}  // namespace tw::test
