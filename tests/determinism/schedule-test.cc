// The committed history does not depend on how a run is carried out: GVT, windows, pieces, frames,
// validators, undoing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <functional>

#include "determinism/compare-schedules.h"
#include "support/callback-scenes.h"

namespace tw::test {
namespace {

std::vector<Scene> scheduled_scenes() {
  return {gas_scene(100),
          lattice_scene(4, 1, 4),
          lattice_scene(4, 1.1, 4),
          cradle_scene(40),
          floor_scene(1.5),
          mixture_scene(20, 4, 0.3, 1),
          paddle_scene(1.5),
          procedure_scene(1),
          callback_on_pairs_scene(3, 1.1, 2),
          callback_without_period_scene(3, 1, 2)};
}

// The schedule as it is, and with an adversary.
std::vector<Schedule> with_and_without_adversary(Schedule schedule, std::uint64_t seed) {
  Schedule hostile = schedule;
  hostile.adversary = adversary_schedule(seed).adversary;
  return {schedule, hostile};
}

std::vector<Schedule> with_adversaries(Schedule schedule, int seeds) {
  std::vector<Schedule> schedules{schedule};
  for (int seed = 0; seed < seeds; ++seed) {
    schedules.push_back(schedule);
    schedules.back().adversary = adversary_schedule(static_cast<std::uint64_t>(seed)).adversary;
  }
  return schedules;
}

template <class Value>
void expect_no_influence(const std::vector<Value>& values,
                         const std::function<void(Schedule&, Value)>& set) {
  std::vector<Schedule> schedules;
  std::uint64_t seed = 13;  // of them all, one with long head starts
  for (const Value value : values) {
    Schedule schedule;
    set(schedule, value);
    for (const Schedule& s : with_and_without_adversary(schedule, seed++)) schedules.push_back(s);
  }
  for (const Scene& scene : scheduled_scenes()) expect_one_history(scene, schedules, 10);
}

TEST(Schedule, gvt_interval_has_no_influence) {
  expect_no_influence<long>({1, 10, 1000, 10000}, [](Schedule& s, long v) { s.gvt_interval = v; });
}

TEST(Schedule, window_has_no_influence) {
  expect_no_influence<double>({0.1, 0.3, 1, 3}, [](Schedule& s, double v) { s.window_cells = v; });
}

TEST(Schedule, pieces_have_no_influence) {
  expect_no_influence<int>({2, 7, 40}, [](Schedule& s, int v) { s.pieces = v; });
}

TEST(Schedule, frame_rate_has_no_influence) {
  expect_no_influence<double>({24, 30, 1000}, [](Schedule& s, double v) { s.fps = v; });
}

TEST(Schedule, observers_have_no_influence) {
  expect_no_influence<bool>({true}, [](Schedule& s, bool v) { s.observe = v; });
}

TEST(Schedule, validators_find_nothing_and_have_no_influence) {
  Schedule checked;
  checked.check = true;
  for (const Scene& scene : scheduled_scenes())
    expect_one_history(scene, with_adversaries(checked, long_tests() ? 20 : 4), 10);
}

TEST(Schedule, undoing_and_redoing_every_discontinuity_has_no_influence) {
  Schedule undone;
  undone.undo_redo = true;
  for (const Scene& scene : scheduled_scenes())
    expect_one_history(scene, with_adversaries(undone, long_tests() ? 50 : 10), 10);
}

// Frames and observations are the same, too: each once and in order.
TEST(Schedule, frames_and_observations_are_the_same_under_adversaries) {
  std::vector<Schedule> schedules = adversaries(long_tests() ? 50 : 10);
  for (Schedule& s : schedules) {
    s.observe = true;
    s.fps = 64;  // frames fall on the impacts of the exact lattice
  }
  for (const Scene& scene : scheduled_scenes()) expect_one_history(scene, schedules, 10);
}

// All settings drawn at random at once.
TEST(Schedule, everything_at_once_has_no_influence) {
  Random random(99);
  std::vector<Schedule> schedules = adversaries(long_tests() ? 50 : 12);
  for (Schedule& s : schedules) {
    const long intervals[] = {0, 1, 7, 100, 3000};
    s.gvt_interval = intervals[random.below(5)];
    s.window_cells = random.real(0.1, 3);
    s.pieces = static_cast<int>(1 + random.below(9));
    s.fps = random.below(2) ? random.real(10, 300) : 0;
    s.check = random.below(3) == 0;
    s.undo_redo = random.below(2) == 0;
    s.observe = random.below(2) == 0;
    s.threads = static_cast<int>(1 + random.below(4));
  }
  schedules.insert(schedules.begin(), Schedule());
  for (const Scene& scene : scheduled_scenes()) expect_one_history(scene, schedules, 10);
}

// Stepping event by event is a run like any other.
TEST(Schedule, single_steps_have_no_influence) {
  for (const Scene& scene : scheduled_scenes()) {
    const Outcome expected = run(scene, Schedule());
    World world;
    apply(world, adversary_schedule(3));
    scene.fill(world);
    for (int i = 0; i < 300 && world.step(scene.duration); ++i) continue;
    world.advance(scene.duration);
    EXPECT_EQ(world.history_hash(), expected.hash) << scene.name;
  }
}

// The same scene again and again in one process, with the heap in another state each time: no bit
// may depend on where an object lies (packet instructions, for one, depend on alignment).
TEST(Schedule, addresses_have_no_influence) {
  for (const Scene& scene : scheduled_scenes()) {
    const Outcome expected = run(scene, Schedule());
    Random random(4);
    std::vector<std::vector<char>> blocks;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 50; ++j) blocks.emplace_back(random.below(5000));
      EXPECT_EQ(run(scene, Schedule()).hash, expected.hash) << scene.name;
    }
  }
}

// Slices of no time at all: the run goes on where it was.
TEST(Schedule, slices_have_no_influence) {
  for (const Scene& scene : scheduled_scenes()) {
    const Outcome expected = run(scene, Schedule());
    World world;
    apply(world, Schedule());
    scene.fill(world);
    while (world.advance(scene.duration, 0) == RunStatus::slice_over) continue;
    EXPECT_EQ(world.history_hash(), expected.hash) << scene.name;
  }
}

}  // namespace
}  // namespace tw::test
