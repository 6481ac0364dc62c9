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

TEST(Parallel, what_helpers_did_is_counted_here) {
  Team team(4);
  const Team::Scope scope(&team);
  const WorkCount before = work_count;
  each_in_parallel(200, 1, [&](std::size_t) {
    each_in_parallel(4, 1, [](std::size_t) { ++work_count.distance_queries; });
  });
  EXPECT_EQ(work_count.since(before).distance_queries, 800u);
}

}  // namespace
}  // namespace tw
