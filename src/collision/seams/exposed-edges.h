// The exposed edges of a polyhedron that run through another one: where neighbours bury the
// features of least depth, these still touch.
//
// A union of convex solids has as corners, besides those of its parts, the points where an edge of
// one part dives into another.  Each stretch of an edge outside the neighbours is a feature of the
// union's own surface; the point of it that lies deepest in the other polyhedron is a contact,
// either under one face (where the stretch ends) or where it crosses an edge.
//
// A point under a face is never deeper than the least translation that would part the two
// polyhedra.
//
// Cost: edges times faces of the other, for those edges that come near it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "collision/seams/seams.h"
#include "geometry/polyhedron.h"

namespace tw {

// In the frame of the edge's polyhedron.
struct ExposedPoint {
  Vec3 point = Vec3::Zero();     // on the edge
  Vec3 opposite = Vec3::Zero();  // on the other's face or edge: opposite - point = gap * normal
  Vec3 normal = Vec3::UnitZ();   // unit, from the edge's polyhedron to the other
  double gap = 0;                // m; negative: depth
  int edge = 0;
  int face = -1;        // of the other, under which the point lies; or
  int other_edge = -1;  // the edge that it crosses
};

// Of a segment, as fractions from tail to head.
struct Stretch {
  double from = 0, to = 1;
  bool empty() const { return !(from <= to); }
};

// Takes from the stretches of a segment (world) what a neighbour holds, and `margin` (m) around
// that.  What runs along the surface of a neighbour is no less exposed than that; neighbours other
// than polyhedra and half-spaces bury nothing.
void leave_exposed(const Vec3& tail, const Vec3& head, const std::vector<SeamNeighbour>& neighbours,
                   double margin, std::vector<Stretch>& stretches);

// `world`: the frame of `part`; `other_in_part` maps the other's frame to it.  Points within
// `margin` (m) of a neighbour are not exposed.  Appends those with gap <= reach.
void exposed_edges(const Polyhedron& part, const Frame& world, const Polyhedron& other,
                   const Frame& other_in_part, const std::vector<SeamNeighbour>& neighbours,
                   double margin, double reach, std::vector<ExposedPoint>& out);

}  // namespace tw
