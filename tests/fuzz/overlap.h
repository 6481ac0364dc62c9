// How deep two described bodies overlap: an oracle that shares nothing with src/collision.
//
// The depth of two convex solids is the least way along which one has to be moved to be free of the
// other: the minimum over unit vectors n of h_A(n) + h_B(-n) with support functions h.  Every n
// gives an upper bound; for polyhedra normals of faces and cross products of edges hold the
// minimum (the separating axis theorem); for round solids rims stand as polygons, libccd's portal
// refinement adds its direction, and the best is climbed from.  (Not libccd's expanding polytope:
// on a cylinder it grows without end.)  So what is reported as free is free, and what is reported
// as deep may be less deep than that only where a round solid has a better direction that none of
// these leads to.
//
// Source: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996 (axes); libccd.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "fuzz/described-scene.h"

namespace tw::fuzz {

// A solid with what the axis tests need, in its body's frame.
struct Part {
  Solid solid;
  Vec3 center = Vec3::Zero();  // inside
  double reach = 0;            // of the ball about the centre that holds it; infinite: half-space
  double width = 0;            // least extent along an axis of its frame
  std::vector<Vec3> corners, normals, edges;  // unit normals and edges, opposite ones once
};

std::vector<Part> parts_of(const DescribedBody& body);

// Least width of a body: of its thinnest part, m; infinite for half-spaces.
double least_width(const std::vector<Part>& parts);

// The overlap of two parts with their bodies at these frames, m; at most 0: free.  A depth that is
// found to be at most `enough` is not looked at more closely.
double overlap(const Part& a, const Frame& frame_a, const Part& b, const Frame& frame_b,
               double enough);

}  // namespace tw::fuzz
