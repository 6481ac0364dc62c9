// Pairs of placed polyhedra: what separation.cc and touching-points.cc share.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/sat.h"
#include "collision/distance/separation.h"
#include "geometry/polyhedron.h"

namespace tw {

// Below this distance, relative to the size of the pair, normals are those of faces and edges.
constexpr double touch_ratio = 1e-9;

// The polyhedral cores of two parts and how they lie.
struct CorePair {
  const Polyhedron& a;
  const Polyhedron& b;
  Frame world_a;  // core A's frame in the world
  Frame b_in_a;   // core B's frame in core A's

  CorePair(const ConvexPart& part_a, const Frame& frame_a, const ConvexPart& part_b,
           const Frame& frame_b)
      : a(*part_a.core), b(*part_b.core), world_a(part_a.in(frame_a)) {
    const Frame world_b = part_b.in(frame_b);
    b_in_a.R = world_a.R.transpose() * world_b.R;
    b_in_a.p = world_a.R.transpose() * (world_b.p - world_a.p);
  }
  double size() const { return a.radius() + b.radius(); }
  // B's view, for features of faces of B.
  Frame a_in_b() const {
    const Mat3 back = b_in_a.R.transpose();
    return {back, -(back * b_in_a.p)};
  }
};

// Where the edges of an axis of kind `edges` cross, in A's frame.
void crossing_of_edges(const CorePair& pair, const LeastAxis& axis, Vec3& on_a, Vec3& on_b);

}  // namespace tw
