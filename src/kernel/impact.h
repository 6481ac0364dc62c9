// Impacts: from two arcs that meet to two new states.
//
// Single points by the impact law; face-on: at the manifold's centroid first, then the worst
// approacher first, at most 200 impulses (dynamics/impulse-solver.h).  A soft impact leaves the
// motion as it is: the two fuse (groups/region.cc).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "collision/separation.h"
#include "groups/surroundings.h"
#include "timeline/collision.h"
#include "timeline/successor.h"

namespace tw {

// Whether somebody wants to be told.
struct Wanted {
  bool collision = false, fusion = false;
};

struct Impact {
  bool soft = false;                 // the two stay in contact
  std::vector<ContactPoint> points;  // of a hard one between two that move freely, one in a group
  std::optional<Collision> told;
};

// Fills the successors of the two bodies, evaluated at the key, with their motion after the impact;
// a soft one leaves it as it is.  Counts in the tally of the first that enters the graph.
Impact compute_impact(const Scene& scene, const Surroundings& surroundings, const Key& key,
                      const Wanted& wanted, Successor& a, Successor& b);

}  // namespace tw
