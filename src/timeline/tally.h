// What one discontinuity adds to the statistics once it is committed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace tw {

// Stands on one state of the discontinuity's ring.
struct Tally {
  std::uint32_t fusions = 0;
  std::uint16_t fissions = 0, contact_changes = 0;
  // what could hide a failure: contacts that still approached after the most impulses, and an
  // impact taken for a soft one because there were too many at its instant
  std::uint8_t impulses_given_up = 0, declared_soft = 0;
  double kinematic_work = 0;    // J, by impulses of kinematic bodies
  double placed_energy = 0;     // J, of contact springs that started loaded
  double momentum_dropped = 0;  // N s, that bodies at the border of a region miss
  double depth = 0;             // m, of the deepest overlap at the points that touch
  // bodies that begin to be squeezed; the deepest overlap of what is, m and over the thinner one's
  // thickness
  std::uint16_t squeezed = 0;
  double squeezed_depth = 0, squeezed_share = 0;

  void note_gap(double gap) { depth = std::max(depth, -gap); }
  void note_squeezed(double most, double share) {
    squeezed_depth = std::max(squeezed_depth, most);
    squeezed_share = std::max(squeezed_share, share);
  }
  void add(const Tally& other) {
    fusions += other.fusions;
    fissions = static_cast<std::uint16_t>(fissions + other.fissions);
    contact_changes = static_cast<std::uint16_t>(contact_changes + other.contact_changes);
    impulses_given_up = static_cast<std::uint8_t>(impulses_given_up + other.impulses_given_up);
    declared_soft = static_cast<std::uint8_t>(declared_soft + other.declared_soft);
    kinematic_work += other.kinematic_work;
    placed_energy += other.placed_energy;
    momentum_dropped += other.momentum_dropped;
    depth = std::max(depth, other.depth);
    squeezed = static_cast<std::uint16_t>(squeezed + other.squeezed);
    note_squeezed(other.squeezed_depth, other.squeezed_share);
  }
};

}  // namespace tw
