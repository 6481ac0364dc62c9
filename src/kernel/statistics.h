// Statistics of a run: one fixed vocabulary (doc/statistics.md).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tw {

// Name and value in the order in which they are shown; numbers are SI.
using StatisticsTable =
    std::vector<std::pair<std::string, std::variant<std::int64_t, double, std::string>>>;

class Delivery;
struct Simulation;

// `distance_queries_made`: by this world.
StatisticsTable statistics_of(const Simulation& simulation, const Delivery& delivery,
                              std::uint64_t distance_queries_made);

}  // namespace tw
