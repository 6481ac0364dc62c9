// Statistics of a run: one fixed vocabulary (doc/statistics.md).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/work-count.h"

namespace tw {

// Name and value in the order in which they are shown; numbers are SI.
using StatisticsTable =
    std::vector<std::pair<std::string, std::variant<std::int64_t, double, std::string>>>;

class Delivery;
struct Simulation;

// Groups whose arcs took most steps, discarded ones too, the dearest first.
struct DearestGroup {
  std::string names;  // a few, and how many bodies there are
  std::size_t bodies = 0;
  std::uint64_t contacts = 0, arcs = 0, steps = 0, rejected = 0;
  double since = 0, until = 0;  // s
  std::string ended_by;         // why most arcs were to end, by plan or end test
};
std::vector<DearestGroup> dearest_groups_of(const Simulation& simulation);

// `work`: for this world.
StatisticsTable statistics_of(const Simulation& simulation, const Delivery& delivery,
                              const WorkCount& work);

}  // namespace tw
