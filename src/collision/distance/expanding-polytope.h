// The depth of the origin in the Minkowski difference of two overlapping cores, by an expanding
// polytope.
//
// A polytope of support points with the origin inside lies within M = A - B: the distance of its
// nearest face bounds the depth from below; the support plane along that face's normal bounds it
// from above. The support point is added to the polytope until both agree.
//
// Source: G. van den Bergen, "Proximity queries and penetration depth computation on 3D game
// objects"// (GDC 2001).
// Cost: grows with the square of the steps; flat contacts take 5 to 15 of them, rims 20 to 60.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "collision/distance/support-core.h"

namespace tw {

struct PolytopeDepth {
  double depth = 0;             // m, the upper bound, along `normal`
  double uncertainty = 0;       // m, upper less lower bound
  Vec3 normal = Vec3::UnitZ();  // unit, from A to B
  Vec3 on_a = Vec3::Zero();     // the point of A that the nearest point of the face came from
};

// The four points enclose the origin.  Ends at an uncertainty of `tolerance` (m) or after many
// steps.
PolytopeDepth polytope_depth(const SupportCore& a, const SupportCore& b, const Vec3& shift,
                             const std::array<DifferencePoint, 4>& enclosing, double tolerance);

}  // namespace tw
