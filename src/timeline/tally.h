// What one discontinuity adds to the statistics once it is committed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace tw {

// Stands on one state of the discontinuity's ring.
struct Tally {
  std::uint16_t fusions = 0, fissions = 0, contact_changes = 0;
  double kinematic_work = 0;  // J, by impulses of kinematic bodies
  double depth = 0;           // m, of the deepest overlap at the points that touch

  void note_gap(double gap) { depth = std::max(depth, -gap); }
  void add(const Tally& other) {
    fusions = static_cast<std::uint16_t>(fusions + other.fusions);
    fissions = static_cast<std::uint16_t>(fissions + other.fissions);
    contact_changes = static_cast<std::uint16_t>(contact_changes + other.contact_changes);
    kinematic_work += other.kinematic_work;
    depth = std::max(depth, other.depth);
  }
};

}  // namespace tw
