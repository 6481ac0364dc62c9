// Looks at two polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/look/look.h"

namespace tw {

// As look_at, `look` being empty.
//
// The axis of the last look comes first: along it most pairs that do not touch are still apart.
// Then a face along which they were sunk a little, and are again: it is taken for the nearest as it
// was, while another may have become so by as little as they have moved.  Else GJK from its last
// simplex, and where they overlap the axis of least penetration.
void look_at_polyhedra(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                       const Frame& frame_b, double reach, ReferenceChoice choice,
                       PairMemory& memory, PartLook& look);

}  // namespace tw
