// How two polyhedra lie: signed distance, axis, and the features that determine them.
//
// Frames: that of A's core.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "collision/distance/gjk.h"
#include "collision/distance/sat.h"
#include "collision/distance/separation.h"
#include "geometry/polyhedron.h"

namespace tw {

// What of one polyhedron is nearest to the other, or deepest in it: its vertices.
struct CoreFeature {
  int count = 0;  // 1: a vertex; 2: an edge or a diagonal of a face; 3: a face
  std::array<int, 3> vertex{};
  int face = -1;  // set where the axis is the normal of this face; then count is 0
};

struct NearestFeatures {
  double distance = 0;          // m; negative: depth of penetration along the axis of least depth
  Vec3 normal = Vec3::UnitZ();  // unit, from A to B
  CoreFeature a, b;
  Vec3 point_a = Vec3::Zero();  // witnesses: point_b - point_a = distance * normal
  Vec3 point_b = Vec3::Zero();
};

// Cold: a function of the frame alone.  Distance to a few 1e-16 of the size.  Where the distance is
// above `reach` only the distance is set, perhaps to a lower bound above `reach`.
NearestFeatures nearest_features(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                                 double reach);

// The same where the answer of a query is there: the axis of least penetration, or GJK's simplex
// and distance.
NearestFeatures nearest_on_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                                const LeastAxis& axis);
NearestFeatures nearest_of_simplex(const CoreDistance& distance, const SimplexCache& simplex);

}  // namespace tw
