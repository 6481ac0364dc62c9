// The surface of a mesh as convex polygons: triangles side by side in one plane joined.
//
// Points within 1e-7 of the size are the same point, what single precision makes of one, and points
// so near a plane lie in it.  Triangles that are thinner, and those that lie on others, are left
// out; those that face the other way than their neighbours are turned.
//
// Frames: the mesh's own, metres.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/shape.h"
#include "math/vec.h"

namespace tw {

// What was wrong with triangles: how many.
struct MeshFaults {
  std::size_t thin = 0;           // left out: no plane goes through them
  std::size_t doubled = 0;        // left out: on another one
  std::size_t back_to_back = 0;   // of these, seen from the other side
  std::size_t turned = 0;         // they faced the other way than those around them
  std::size_t open_sides = 0;     // sides without a neighbour
  std::size_t crowded_sides = 0;  // sides of more than two triangles: none is the other's neighbour
};

struct MeshFace {
  static constexpr std::int32_t none = -1;

  std::vector<std::uint32_t> corners;  // counter-clockwise from outside; some lie on straight sides
  std::vector<std::int32_t>
      neighbours;  // the face beyond the side that begins at a corner, or none
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;  // the plane: normal.x = offset
};

struct MeshFaces {
  std::vector<Vec3> points;
  std::vector<MeshFace> faces;
  double tolerance = 0;  // m: points so near are one
};

// Errors: UserError where no triangle is left.
MeshFaces mesh_faces(const std::vector<Vec3>& points, const std::vector<MeshTriangle>& triangles,
                     MeshFaults& faults);

}  // namespace tw
