// The points where a face of one polyhedron lies on the other polyhedron.
//
// The face most opposite among those at the other's deepest vertex is clipped by the side planes of
// the reference face (I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", Comm. ACM 17
// (1974)); what is left is measured against the reference plane.
//
// Frames: that of the reference polyhedron.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/polyhedron.h"

namespace tw {

// A point of the other polyhedron's surface and its height over the reference face.
struct ClippedPoint {
  Vec3 point;
  double gap = 0;
};

// All corners of the clipped face with gap <= tolerance, in cyclic order, at most `most` of them
// (the deepest, then always the one farthest from those chosen).  `other_in_reference` maps the
// other's frame; `deepest` is its support vertex against the face's normal.  Overwrites `out`.
void clip_face(const Polyhedron& reference, int face, const Polyhedron& other,
               const Frame& other_in_reference, int deepest, double tolerance, std::size_t most,
               std::vector<ClippedPoint>& out);

// Thins points to at most `most`, as above; keeps their order.
void thin_points(std::vector<ClippedPoint>& points, std::size_t most);

}  // namespace tw
