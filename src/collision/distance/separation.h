// Signed distance and touching points of placed shapes.
//
// Everything here is *cold*: a function of the two poses alone, bit for bit, unless a cache is
// handed in; what enters a state is always a cold query (see doc/architecture.md, "the schedule
// never changes the answer").
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/shape.h"

namespace tw {

// How two placed shapes lie: the least signed distance over all pairs of parts.
struct Separation {
  double distance = 0;          // m; negative: depth of penetration; 0: touching
  Vec3 normal = Vec3::UnitZ();  // unit, world, from a to b
  Vec3 point_a = Vec3::Zero();  // witness on a's surface, world
  Vec3 point_b = Vec3::Zero();  // witness on b's surface, world
  int part_a = 0;
  int part_b = 0;
};

// The last simplex of a pair of parts: where the next query starts.  Default: nothing known.
struct SimplexCache {
  int count = 0;
  std::array<int, 4> vertex_a{};
  std::array<int, 4> vertex_b{};
};

// One pair of parts, each with its *body's* frame; work_count.distance_queries counts these.  The
// distance is exact to about 1e-15 of the size whether separate, touching or penetrating.  While
// parts are separate the normal is along the witness points; at touch or in penetration it is the
// axis of least penetration, exact too. `cache` may be null (cold).  Frustums and ellipsoids
// against polyhedra and one another: see round-distance.h.
Separation part_separation(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                           const Frame& frame_b, SimplexCache* cache);

// The least over all pairs of parts, cold.  Ties: the first pair in order of part numbers.
Separation separation(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b);
// Its distance alone, with the same bits.
double signed_distance(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b);

// One point where two shapes touch.
struct ContactPoint {
  Vec3 point = Vec3::Zero();    // world, midway between the surfaces
  Vec3 normal = Vec3::UnitZ();  // unit, world, from a to b
  double gap = 0;               // m, signed, along the normal
  int pair = 0;                 // which pair of parts: points of one manifold share it
};

// All points of all pairs of parts with gap <= tolerance (m): one for a sphere, the clipped face
// (up to 8) for two faces, the crossing of two edges for edges.  Cold; normals are face or edge
// axes, exact at touch.  Ordered by part pair, then deterministically within the manifold; appended
// to `out`.  Two half-spaces have none.
void touching_points(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
                     double tolerance, std::vector<ContactPoint>& out);

}  // namespace tw
