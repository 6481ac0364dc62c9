// Impacts: from two arcs that meet to two new states.
//
// Two that nothing else touches or holds: single points by the impact law; face-on at the
// manifold's centroid first, then the worst approacher first, at most 200 impulses
// (dynamics/impulse-solver.h).  In a group whoever carries takes the blow up, too
// (groups/regroup/blow.h). A soft impact leaves the motion as it is: the two fuse
// (groups/contacts/contact-graph.h).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "groups/contacts/surroundings.h"
#include "groups/regroup/regroup.h"
#include "timeline/collision.h"
#include "timeline/successor.h"

namespace tw {

// Whether somebody wants to be told.
struct Wanted {
  bool collision = false, fusion = false;
};

struct Impact {
  bool soft = false;  // the two stay in contact
  std::optional<Collision> told;
};

// Gives the first two successors, evaluated at the key, their motion after the impact, and adds
// those of others that a blow reaches; a soft one leaves it as it is.  Counts in the tally of the
// first that enters the graph.  Or whose arcs must be known first.
std::variant<Impact, Waits> compute_impact(const Before& before, const Surroundings& surroundings,
                                           const Known& known, const Wanted& wanted,
                                           std::vector<Successor>& successors);

}  // namespace tw
