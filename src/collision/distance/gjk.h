// Distance of two separate convex cores by the algorithm of Gilbert, Johnson and Keerthi.
//
// Each step asks for the point of the Minkowski difference farthest against v, the nearest point so
// far, and reduces the simplex.  It ends when the support plane through the new point proves that
// no more than rounding can be gained, when the new point is known already, or when |v| stops
// falling; there is no tolerance to choose.
//
// Accuracy: distance to a few 1e-16 of the size at every gap; the normal of vertex against face and
// of edge against edge likewise, of other features to 1e-16 size/gap.  Touching and overlapping
// cores are for collision/distance/sat.h.
//
// Frames: that of A's core.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/separation.h"
#include "geometry/polyhedron.h"

namespace tw {

struct CoreDistance {
  bool overlap = false;         // nothing else is set then
  double distance = 0;          // m, >= 0
  Vec3 normal = Vec3::Zero();   // unit, from A to B; zero where the distance is exactly 0
  Vec3 point_a = Vec3::Zero();  // witness on A; the one on B is point_a + distance * normal
};

// `b_in_a` maps B's frame to A's.  The cache, if any, is where the search starts, and gets its end.
CoreDistance core_distance(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                           SimplexCache* cache);
// The same for a point in A's frame.
CoreDistance core_distance(const Polyhedron& a, const Vec3& point, SimplexCache* cache);

}  // namespace tw
