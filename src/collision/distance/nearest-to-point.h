// The feature of a polyhedron that is nearest to a point.
//
// Outside, the face with the greatest height is the answer where the foot of the point lies in it;
// else the nearest edge or vertex is.  Inside, and where edges and vertices would lose the
// direction, it is the face of least depth.
//
// Frames: the polyhedron's own.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "collision/manifold/manifold.h"
#include "geometry/polyhedron.h"

namespace tw {

struct NearestToPoint {
  ContactFeature kind = ContactFeature::plane;
  Vec3 normal = Vec3::UnitZ();     // unit, outward to the point
  Vec3 direction = Vec3::UnitX();  // of an edge
  Vec3 point = Vec3::Zero();       // the nearest
  double distance = 0;             // m, signed
  std::uint64_t number = 0;        // of the face, edge or vertex
};

NearestToPoint nearest_to_point(const Polyhedron& p, const Vec3& point);
// The same over the edges and vertices alone; the point isn't on one.
NearestToPoint nearest_edge(const Polyhedron& p, const Vec3& point);

// Whether the foot of the point on the face's plane lies within its sides, up to `slack` beyond.
bool over_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point, double slack);
// The point of the face that is nearest.
Vec3 nearest_on_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point);

}  // namespace tw
