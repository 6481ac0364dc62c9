// The committed history does not depend on how many threads share the work.  `make check` under
// ThreadSanitizer (configure --enable-sanitizers=thread) runs these above all.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "determinism/compare-schedules.h"
#include "support/callback-scenes.h"
#include "support/heap-scenes.h"

namespace tw::test {
namespace {

std::vector<Scene> shared_scenes() {
  return {gas_scene(100),
          mixture_scene(20, 4, 0.3, 1),
          paddle_scene(1.5),
          procedure_scene(1),
          heap_scene(12, 1.2),
          tower_scene(4, 1),
          platform_scene(0.8),
          tiles_scene(0.8),
          callback_on_pairs_scene(3, 1.1, 2)};
}

Schedule with_threads(int threads) {
  Schedule schedule;
  schedule.threads = threads;
  return schedule;
}

TEST(Threads, have_no_influence) {
  const std::vector<Schedule> schedules{with_threads(2), with_threads(3), with_threads(8)};
  for (const Scene& scene : shared_scenes()) expect_one_history(scene, schedules, 3);
}

// Large enough for loops within groups, and for regions.
TEST(Threads, have_no_influence_on_a_large_heap) {
  const std::vector<Schedule> schedules{with_threads(2), with_threads(3), with_threads(8)};
  expect_one_history(heap_scene(60, long_tests() ? 2 : 0.8), schedules, 3);
  expect_one_history(tumbler_scene(40, long_tests() ? 2 : 0.6), schedules, 3);
}

// What was decided ahead is undone, redone and decided anew.
TEST(Threads, have_no_influence_under_adversaries_and_undoing) {
  std::vector<Schedule> schedules;
  for (std::uint64_t seed = 0; seed < (long_tests() ? 40u : 8u); ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 0.01 * static_cast<double>(1 + seed % 5);
    schedule.threads = 2 + static_cast<int>(seed % 3);
    schedule.check = seed % 4 == 1;
    schedule.pieces = seed % 4 == 2 ? 5 : 1;
    schedules.push_back(schedule);
  }
  Schedule undone = with_threads(3);
  undone.undo_redo = true;
  schedules.push_back(undone);
  const Tally heap = expect_one_history(heap_scene(20, 1), schedules, 3);
  EXPECT_GT(heap.rollbacks, 20);
  expect_one_history(tumbler_scene(16, 0.5), schedules, 3);
  expect_one_history(tower_scene(4, 1), schedules, 3);
}

// The same work is done, whoever does it.
TEST(Threads, count_as_one_does) {
  std::int64_t queries[2], claims[2];
  for (const int i : {0, 1}) {
    World world;
    world.set_threads(1 + 2 * i);
    heap_scene(20, 1).fill(world);
    world.advance(1);
    for (const auto& [name, value] : world.statistics()) {
      if (name == "distance_queries") queries[i] = std::get<std::int64_t>(value);
      if (name == "claims") claims[i] = std::get<std::int64_t>(value);
    }
  }
  EXPECT_EQ(claims[0], claims[1]);
  // and what was decided ahead in vain
  EXPECT_GE(queries[1], queries[0]);
  EXPECT_LT(static_cast<double>(queries[1]), 1.2 * static_cast<double>(queries[0]));
}

// A check that falls to several groups of one heap is decided by one of them.
TEST(Threads, decide_little_in_vain) {
  World world;
  world.set_threads(2);
  heap_scene(60, 0).fill(world);
  world.advance(1.2);
  const std::int64_t ahead = count_of(world.statistics(), "checks_decided_ahead");
  EXPECT_GT(ahead, 500);
  EXPECT_LT(count_of(world.statistics(), "checks_decided_in_vain"), ahead / 10);
}

// Impacts are decided beside the claims of the ones before, which the history does not show.
void expect_impacts_decided_ahead(const Scene& scene) {
  World world;
  world.set_threads(2);
  scene.fill(world);
  const auto count = [&](const char* of) { return count_of(world.statistics(), of); };
  const auto used = [&] {
    return count("impacts_decided_ahead") - count("impacts_decided_in_vain");
  };
  // on a busy machine a helper may have to wait for a core
  double until = 0;
  while (used() == 0 && until < 4) world.advance(until += 0.1);
  EXPECT_GT(used(), 0) << scene.name;
}

TEST(Threads, decide_impacts_ahead) {
  expect_impacts_decided_ahead(heap_scene(60, 0));
  // of what a moving wall carries, too
  expect_impacts_decided_ahead(tumbler_scene(12, 4));
}

TEST(Threads, number_is_checked) {
  World world;
  EXPECT_THROW(world.set_threads(-1), UserError);
  EXPECT_THROW(world.set_threads(1000), UserError);
}

}  // namespace
}  // namespace tw::test
