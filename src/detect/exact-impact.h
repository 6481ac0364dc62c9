// Exact impacts: of spheres that fall alike, and of a sphere and a fixed plane, by a quadratic.
//
// Cost: some tens of nanoseconds, no distance query; no grid and no safe time are needed.
// Source: collision/distance/impact-time.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "detect/piece.h"

namespace tw {

// Whether the two meet as a quadratic says on this piece.
bool predicted_exactly(const Piece& piece);
// Time of the first impact on the piece's arcs as if they were never cut, s; `never` if there is
// none.  At the common start what an impact left behind is no approach.  Only where predicted
// exactly.
double exact_impact(const Piece& piece);

}  // namespace tw
