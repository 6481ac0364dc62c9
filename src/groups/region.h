// The bodies that a discontinuity concerns: those that get new arcs, and those that these meet.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/world.h"

namespace tw {

// A group of fewer members is always taken whole.
inline constexpr std::size_t least_divided = 8;

struct Region {
  std::vector<BodyId> inside, border;  // dynamic, ascending
  // What it depends on beyond its border: why a group that comes to rest does so provisionally
  // (calm.cc).
  std::vector<BodyId> depends_on;
};

}  // namespace tw
