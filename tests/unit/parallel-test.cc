// Loops on several threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/interruption.h"
#include "base/work-count.h"

namespace tw {
namespace {

void wait_a_little() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

TEST(Parallel, every_item_comes_once) {
  Team team(4);
  const Team::Scope scope(&team);
  for (const std::size_t items : {0u, 1u, 2u, 7u, 1000u}) {
    std::vector<int> done(items, 0);
    each_in_parallel(items, 1, [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), static_cast<int>(items));
    for (const int times : done) EXPECT_EQ(times, 1);
  }
}

TEST(Parallel, others_help) {
  Team team(3);
  const Team::Scope scope(&team);
  const auto self = std::this_thread::get_id();
  // on a busy machine a helper may have to wait for a core
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  std::atomic<bool> helped = false;
  each_in_parallel(60, 1, [&](std::size_t) {
    if (std::this_thread::get_id() != self) helped = true;
    while (!helped && std::chrono::steady_clock::now() < late) wait_a_little();
  });
  EXPECT_TRUE(helped);
}

TEST(Parallel, without_a_team_or_below_the_grain_a_loop_is_a_loop) {
  const auto self = std::this_thread::get_id();
  const auto expect_alone = [&](std::size_t items, std::size_t grain) {
    std::size_t next = 0;
    each_in_parallel(items, grain, [&](std::size_t i) {
      EXPECT_EQ(i, next++);
      EXPECT_EQ(std::this_thread::get_id(), self);
    });
    EXPECT_EQ(next, items);
  };
  expect_alone(100, 1);
  Team alone(1), team(4);
  {
    const Team::Scope scope(&alone);
    expect_alone(100, 1);
  }
  const Team::Scope scope(&team);
  expect_alone(31, 16);
  const Team::Scope none(nullptr);
  expect_alone(100, 1);
}

TEST(Parallel, loops_within_loops_are_shared_and_keep_apart) {
  Team team(4);
  const Team::Scope scope(&team);
  thread_local int depth = 0;  // scratch that an item of another loop may not find in use
  std::vector<std::vector<int>> sums(40, std::vector<int>(40, 0));
  std::atomic<int> mixed{0};
  each_in_parallel(sums.size(), 1, [&](std::size_t i) {
    mixed += depth != 0;
    ++depth;
    each_in_parallel(sums[i].size(), 1, [&](std::size_t j) {
      if (j % 8 == 0) wait_a_little();
      sums[i][j] = static_cast<int>(i * j);
    });
    --depth;
  });
  EXPECT_EQ(mixed, 0);
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t j = 0; j < sums.size(); ++j) EXPECT_EQ(sums[i][j], static_cast<int>(i * j));
}

// Helpers that have gone to sleep between two loops come back.
TEST(Parallel, loops_far_apart_are_shared_as_well) {
  Team team(2);
  const Team::Scope scope(&team);
  const auto self = std::this_thread::get_id();
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  for (int round = 0; round < 20; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::atomic<bool> helped = false;
    std::vector<int> done(8, 0);
    each_in_parallel(done.size(), 1, [&](std::size_t i) {
      ++done[i];
      if (std::this_thread::get_id() != self) helped = true;
      while (!helped && std::chrono::steady_clock::now() < late) wait_a_little();
    });
    EXPECT_TRUE(helped) << round;
    for (const int times : done) EXPECT_EQ(times, 1);
  }
}

TEST(Parallel, who_waits_for_the_last_item_helps_with_the_loops_within_it) {
  Team team(2);
  const Team::Scope scope(&team);
  const std::thread::id self = std::this_thread::get_id();
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  const auto wait_for = [&](const auto& it) {
    while (!it() && std::chrono::steady_clock::now() < late) wait_a_little();
  };
  std::atomic<bool> taken = false;
  std::atomic<int> begun = 0;
  each_in_parallel(2, 1, [&](std::size_t) {
    if (std::this_thread::get_id() == self) return wait_for([&] { return taken.load(); });
    taken = true;
    // neither of these ends before the other one has begun
    each_in_parallel(2, 1, [&](std::size_t) {
      ++begun;
      wait_for([&] { return begun.load() == 2; });
    });
  });
  EXPECT_TRUE(taken);
  EXPECT_LT(std::chrono::steady_clock::now(), late);
}

TEST(Parallel, an_exception_of_an_item_comes_out) {
  Team team(3);
  const Team::Scope scope(&team);
  const auto loop = [] {
    each_in_parallel(100, 1, [](std::size_t i) {
      if (i == 57) throw std::runtime_error("of 57");
    });
  };
  EXPECT_THROW(loop(), std::runtime_error);
  int done = 0;
  each_in_parallel(1, 1, [&](std::size_t) { ++done; });
  EXPECT_EQ(done, 1);
}

// Items that end when they are interrupted, and which gave up.
struct Endless {
  std::atomic<int> begun = 0, interrupted = 0, ended = 0;
  void operator()() {
    ++begun;
    const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < late) {
      try {
        raise_if_interrupted();
      } catch (const Interrupted&) {
        ++interrupted;
        throw;
      }
      wait_a_little();
    }
    ++ended;
  }
};

TEST(Parallel, who_is_interrupted_while_waiting_interrupts_the_helpers) {
  Team team(2);
  const Team::Scope scope(&team);
  const auto self = std::this_thread::get_id();
  const InterruptionCheck check([] { throw Interrupted(); });
  Endless endless;
  const auto loop = [&] {
    each_in_parallel(2, 1, [&](std::size_t) {
      if (std::this_thread::get_id() != self) return endless();
      while (endless.begun == 0) wait_a_little();
    });
  };
  EXPECT_THROW(loop(), Interrupted);
  EXPECT_EQ(endless.interrupted, 1);
  EXPECT_EQ(endless.ended, 0);
}

TEST(Parallel, who_is_interrupted_at_an_item_interrupts_loops_within_others) {
  Team team(2);
  const Team::Scope scope(&team);
  const auto self = std::this_thread::get_id();
  const InterruptionCheck check([] { throw Interrupted(); });
  Endless endless;
  const auto loop = [&] {
    each_in_parallel(2, 1, [&](std::size_t) {
      if (std::this_thread::get_id() != self)
        return each_in_parallel(2, 1, [&](std::size_t) {
          if (std::this_thread::get_id() != self) endless();
        });
      while (endless.begun == 0) wait_a_little();
      raise_if_interrupted();
    });
  };
  EXPECT_THROW(loop(), Interrupted);
  EXPECT_EQ(endless.ended, 0);
}

TEST(Parallel, an_interrupt_is_put_off_where_items_do_not_ask) {
  Team team(2);
  const Team::Scope scope(&team);
  static std::atomic<int> asked;
  asked = 0;
  const InterruptionCheck check([] {
    if (asked++ == 0) throw Interrupted();
  });
  const auto self = std::this_thread::get_id();
  std::atomic<bool> helped = false;
  each_in_parallel(2, 1, [&](std::size_t) {
    if (std::this_thread::get_id() == self) {
      while (!helped) wait_a_little();
    } else {
      helped = true;
      while (asked == 0) wait_a_little();
    }
  });
  EXPECT_THROW(raise_if_interrupted(), Interrupted);
  raise_if_interrupted();
}

TEST(Parallel, what_helpers_did_is_counted_here) {
  Team team(4);
  const Team::Scope scope(&team);
  const WorkCount before = work_count;
  each_in_parallel(200, 1, [&](std::size_t) {
    each_in_parallel(4, 1, [](std::size_t) { ++work_count.distance_queries; });
  });
  EXPECT_EQ(work_count.since(before).distance_queries, 800u);
}

// Waits for it, up to 20 s, without taking it back.
bool is_over_in_time(const Beside& beside) {
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!beside.is_over() && std::chrono::steady_clock::now() < late) wait_a_little();
  return beside.is_over();
}

TEST(Beside, a_helper_does_it_meanwhile) {
  Team team(2);
  std::thread::id who;
  Beside beside(team, [&] { who = std::this_thread::get_id(); });
  ASSERT_TRUE(is_over_in_time(beside));
  EXPECT_TRUE(beside.finish());
  EXPECT_TRUE(beside.finish());
  EXPECT_NE(who, std::this_thread::get_id());
  EXPECT_NE(who, std::thread::id());
}

TEST(Beside, it_is_done_as_a_whole_or_not_begun) {
  Team team(2);
  for (int i = 0; i < 200; ++i) {
    int steps = 0;
    Beside beside(team, [&] {
      ++steps;
      if (i % 3 == 0) wait_a_little();
      ++steps;
    });
    if (i % 2 == 0) std::this_thread::yield();
    const bool was_done = beside.finish();
    EXPECT_EQ(steps, was_done ? 2 : 0);
    EXPECT_TRUE(beside.is_over());
  }
  // nobody helps here
  Team alone(1);
  int steps = 0;
  Beside beside(alone, [&] { ++steps; });
  EXPECT_FALSE(beside.finish());
  EXPECT_EQ(steps, 0);
}

TEST(Beside, what_it_throws_is_lost_and_it_was_not_done) {
  Team team(2);
  Beside beside(team, [] { throw std::runtime_error("no"); });
  ASSERT_TRUE(is_over_in_time(beside));
  EXPECT_FALSE(beside.finish());
}

TEST(Beside, loops_go_on_meanwhile_here_and_there) {
  Team team(3);
  const Team::Scope scope(&team);
  std::vector<int> there(1000), here(1000);
  Beside beside(team,
                [&] { each_in_parallel(there.size(), 1, [&](std::size_t i) { ++there[i]; }); });
  each_in_parallel(here.size(), 1, [&](std::size_t i) { ++here[i]; });
  const int expected = beside.finish() ? 1 : 0;
  for (const int times : here) EXPECT_EQ(times, 1);
  for (const int times : there) EXPECT_EQ(times, expected);
}

TEST(Beside, its_work_counts_for_who_waits_for_it) {
  Team team(2);
  const WorkCount before = work_count;
  Beside beside(team, [] { work_count.distance_queries += 7; });
  ASSERT_TRUE(is_over_in_time(beside));
  EXPECT_TRUE(beside.finish());
  EXPECT_EQ(work_count.since(before).distance_queries, 7u);
}

}  // namespace
}  // namespace tw
