// Meshes from files, as points or triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace tw {

// All vertices of a file that Assimp reads (STL, OBJ, Collada and others), with the transforms of
// its scene applied, in the file's unit.  Errors: UserError, with the file's name, where it is
// missing, is no mesh, or has fewer than four vertices.
std::vector<Vec3> mesh_points(const std::string& file);

// One mesh of such a file: three corners a triangle.
struct NamedTriangles {
  std::string name;  // empty where the file has none
  std::vector<Vec3> corners;
};

// The same as triangles; flat pieces of lines and points are left out.
std::vector<NamedTriangles> mesh_triangles(const std::string& file);

}  // namespace tw
