// A plane that turns with the features that face each other.
//
// Two edges that pass each other, or a face and what stands before it, keep a plane between them
// only if it turns with them: a plane at rest is crossed at once by the far end of an edge, however
// slowly the two approach.  Let n be the normal from a to b, c the point between the witnesses and
// n' the rate of n that keeps the vertices of the facing features at their heights.  Then the
// height of a point p, h = n.(p - c), has
//   h'  = n'.(p - c) + n.(v_p - u)
//   |h'' - n.(a_p - a_c)| <= 2 |n'| |v_p - u| + |n'|^2 |p - c| + |n'| t |a_p - a_c|
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/separation.h"
#include "detect/moving-body.h"

namespace tw {

// Whether the plane is for this body and part: what is bounded, and stands or moves by an arc.
bool can_turn(const MovingBody& side, const ConvexPart& part);

// Seconds until the two parts may meet; `s`: their separation, world.  Overlaps up to `allowance`
// (m) do not count.  0 where the parts touch.
double turning_time_apart(const MovingBody& a, const ConvexPart& part_a, const MovingBody& b,
                          const ConvexPart& part_b, const Separation& s, double allowance);

}  // namespace tw
