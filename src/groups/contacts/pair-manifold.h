// Where two bodies touch, for contacts, impacts and the end test: all see the same.
//
// What the shapes alone say is not all: neighbouring pieces of the ground bury edges of each other
// (collision/seams), and the sides of ground that goes on as a plane are none to what stands on it
// (flush-ground.h).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/contacts/flush-ground.h"
#include "groups/contacts/surroundings.h"

namespace tw {

// The parts of the ground that stand beside the one of the two that is ground.
struct PairGround {
  std::vector<SeamNeighbour> around_a, around_b;

  PairGround() = default;
  PairGround(const Surroundings& surroundings, const Body& a, const Body& b,
             const NearGround& ground)
      : around_a(surroundings.seam_neighbours(a, ground)),
        around_b(surroundings.seam_neighbours(b, ground)) {}
};

struct PairManifold {
  double distance = never;  // m, of the nearest points, buried or not; negative: depth
  bool left_out = false;    // sides of what goes on as a plane
};

// Adds the points where the two are no farther apart than `reach`, m.  `planes`: of the ground, on
// which the one that moves stands.
PairManifold pair_manifold(const PairPlace& pair, const PairGround& ground,
                           const std::vector<StandingPlane>& planes, double reach,
                           std::vector<ManifoldPoint>& points);

}  // namespace tw
