// Timing and statistics for the benchmark programs that print Markdown tables (bench-table.h).
//
// CPU time of this thread, never wall time: the machine is shared.  The best of several runs is
// what counts: everything that disturbs a run makes it slower.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <ctime>
#include <stdexcept>
#include <string>
#include <variant>

#include "bench/bench-table.h"
#include "kernel/world/world.h"

namespace tw::bench {

// CPU seconds of this thread so far.
inline double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// One number of World::statistics().
inline double statistic(const World& world, const std::string& name) {
  for (const auto& [key, value] : world.statistics()) {
    if (key != name) continue;
    if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
    return std::get<double>(value);
  }
  throw std::runtime_error("no statistic " + name);
}

// What a run cost: its start (first claims and predictions, check for overlaps), then the loop.
struct RunCost {
  double start = 0, loop = 0;  // s
};

inline RunCost run(World& world, double until) {
  RunCost cost;
  world.advance(0);
  cost.start = statistic(world, "cpu_seconds");
  world.advance(until);
  cost.loop = statistic(world, "cpu_seconds") - cost.start;
  return cost;
}

}  // namespace tw::bench
