// Runs a scene in order and under other schedules, and expects the same history.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "support/schedule.h"

namespace tw::test {

inline constexpr int adversary_seeds = 50;

inline void report(const Scene& scene, const Tally& tally) {
  const double runs = std::max(1, tally.runs);
  std::printf(
      "  %-34s %3d runs: %7.0f collisions, %7.1f rollbacks a run, %4.1f states each, "
      "deepest %.3f s, largest cascade %d bodies\n",
      scene.name.c_str(), tally.runs, static_cast<double>(tally.collisions) / runs,
      static_cast<double>(tally.rollbacks) / runs,
      static_cast<double>(tally.removed) /
          static_cast<double>(std::max<std::int64_t>(1, tally.rollbacks)),
      tally.depth, static_cast<int>(tally.cascade));
  std::fflush(stdout);
  testing::Test::RecordProperty(scene.name + " rollbacks", static_cast<int>(tally.rollbacks));
  testing::Test::RecordProperty(scene.name + " largest cascade", static_cast<int>(tally.cascade));
}

// Equal hashes of history, frames and observations under every schedule; returns what it took.
// `least_collisions` guards against a scene in which nothing happens.
inline Tally expect_one_history(const Scene& scene, const std::vector<Schedule>& schedules,
                                std::int64_t least_collisions) {
  Schedule in_order;
  in_order.observe = schedules.front().observe;
  in_order.fps = schedules.front().fps;
  const Outcome expected = run(scene, in_order);
  EXPECT_GE(expected.collisions, least_collisions) << scene.name;

  Tally tally;
  int different = 0;
  for (const Schedule& schedule : schedules) {
    const Outcome outcome = run(scene, schedule);
    tally.add(outcome);
    EXPECT_EQ(outcome.collisions, expected.collisions) << scene.name << ": " << describe(schedule);
    EXPECT_EQ(outcome.hash, expected.hash) << scene.name << ": " << describe(schedule);
    EXPECT_TRUE(outcome.frames_in_order && outcome.observed_in_order) << describe(schedule);
    if (schedule.fps == in_order.fps) {
      EXPECT_EQ(outcome.frames, expected.frames) << scene.name << ": " << describe(schedule);
    }
    if (schedule.observe == in_order.observe) {
      EXPECT_EQ(outcome.observed, expected.observed) << scene.name << ": " << describe(schedule);
    }
    different += outcome.hash != expected.hash;
    if (different > 3) break;  // enough to see the pattern
  }
  report(scene, tally);
  return tally;
}

inline std::vector<Schedule> adversaries(int seeds) {
  std::vector<Schedule> schedules;
  for (int seed = 0; seed < seeds; ++seed)
    schedules.push_back(adversary_schedule(static_cast<std::uint64_t>(seed)));
  return schedules;
}

}  // namespace tw::test
