// The contact graph: which pairs are in contact, at which points, and what becomes of their
// friction stretches.
//
// Whether a pair is in contact is a function of the poses and velocities at the discontinuity, of
// whether it was before, and of the interval until the next check; candidates are who was in
// contact before, and whom the spatial hash has near: new contacts are looked for no farther than
// its boxes are grown, so none is missed, however small claims and GVT make them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// The groups that the successors come from, and the contact pairs of those that get new arcs.
void collect_old(Regrouping& work);

// The pair and its contacts as they stand, stretches evaluated at the discontinuity.
void carry(Regrouping& work, const PairBefore& old);

// All contact pairs of some of the processes with new arcs, anew; those of the others as they
// stand. `interval`: until the next check, s.  `looked_at`: ascending.
void refresh(Regrouping& work, const std::vector<ProcessId>& looked_at, double interval);

// The first two successors come to touch: they are in contact whatever their manifold says.  So are
// all pairs placed together with them that do touch, and hardly part or close.
void fuse(Regrouping& work, double interval);

}  // namespace tw
