// Looks at two polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/look/look.h"

namespace tw {

// As look_at, `look` being empty.
//
// The axis of the last look comes first: along it most pairs that do not touch are still apart.
// Then a face along which they were sunk a little, and are again: they touch there, whatever else
// they might (that face is nearer than any other by more than they have moved, or the next look is
// wrong by as much as a look is late).  Else GJK from its last simplex, and where they overlap the
// axis of least penetration.
void look_at_polyhedra(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, double reach, ReferenceChoice choice,
                       PairMemory& memory, PartLook& look);

}  // namespace tw
