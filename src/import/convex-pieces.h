// A closed surface, however concave, as convex pieces: what moving bodies of such a shape are made
// of.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/shape.h"

namespace tw {

// Triangles by the numbers of their points.
struct ClosedSurface {
  std::vector<std::array<std::size_t, 3>> triangles;
  bool cavity = false;  // of the first one, which is none itself
};

struct ConvexPieces {
  ShapePtr shape;  // the union of the pieces, with the mass of the cells
  std::size_t pieces = 0;
  std::size_t holes = 0;      // in the surfaces, which were closed
  std::size_t triangles = 0;  // that were decomposed
  double volume = 0;          // within the surfaces as they were given, holes closed, m^3
};

// The exact cells into which timewarp-decompose splits the solid, joined again where their hulls
// stand out over its surface by no more than 4 / `most` of its size.  A surface of more than `most`
// triangles and half as many concave edges is simplified first.  Mass properties are those of the
// cells.  Two minutes of CPU time and 4 GB for the cells.
//
// Errors (UserError; `what`, which they begin with, is decomposed): no program, a surface that cuts
// itself, too much work.
ConvexPieces convex_pieces(const std::string& what, const std::vector<Vec3>& points,
                           const std::vector<ClosedSurface>& surfaces, std::size_t most);

}  // namespace tw
