// How far two bodies overlap along one direction: what one of them would have to be moved by to
// part them, and so no less than they are deep in each other.  Two support points, an eighth of
// what a manifold costs.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "geometry/shape.h"

namespace tw {

// m, negative where they are apart; `normal`: unit vector of the world from a towards b.  Infinite
// where one of them is anything but a single polyhedron.
double overlap_along(const Vec3& normal, const Shape& a, const Frame& frame_a, const Shape& b,
                     const Frame& frame_b);

}  // namespace tw
