// Regions: which processes a discontinuity gives new arcs.
//
// What happens to one body of a heap moves others the less the farther away they are: the next few
// feel it, the hundredth does not before the next group check.  So a discontinuity gives new arcs
// to the processes it concerns and to those that touch them.  What these meet at their border
// follows the arcs that it has; but where it would *notice*, it is taken in too, until nobody at
// the border would: the region is a least fixpoint, found by a work list (regroup.h).  At the group
// check that was due all join again.
//
// Both arcs of a border's contact hold the same features; the group that was made last owns it.
// Those at the border get a record, so that a rollback of theirs takes those back that relied on
// them.
//
// Measured: a blow on a heap of 90 sliding rocks moves 4 to 6 of them by more than 1 mm/s before
// the next check.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/contacts/contacts.h"

namespace tw {

struct Region {
  std::vector<ProcessId> inside, border;  // dynamic, ascending
};

// Of a discontinuity that concerns the dynamic processes `struck`.  `whole`: with all their groups.
Region region_of(const Before& before, const std::vector<ProcessId>& struck, bool whole);

// The region with these taken in, and those that touch them: in a chain each step would find two
// more at its ends and throw all arcs away, so it is at least twice as large then, if so many
// touch.
void widen(Region& region, const Before& before, const std::vector<ProcessId>& more);

struct Noticed {
  std::vector<ProcessId> by;
  double momentum_dropped = 0;  // N s, that others miss who do not notice
};

// Who at the border would notice, once the groups are made; integrates those with a border to their
// ends.  None twice in a row is the fixpoint.
//
// What moves notices an impulse that its arc does not know of, where that changes its velocity by
// more than a share of what a step of the integrator may be wrong by; what rests a change of the
// force on it by a share of its weight, or of the torque by as much at a lever that counts.
// Changes are compared with the arc as it was made: small ones add up.
Noticed who_notices(const Regrouping& work, const Contacts& contacts, const Groups& made);

}  // namespace tw
