// Coarser versions of a mesh's triangles, for where they are small in the picture.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "render/mesh.h"

namespace tw {

// Indices in a row, of triangles that are about `error` from those of the mesh, as quadrics
// estimate.
struct MeshLevel {
  std::uint32_t first = 0, count = 0;
  double error = 0;  // m
};

// Of a patch: that of the mesh itself, and coarser ones after it, each with at most three quarters
// of the triangles of the one before, whose vertices and indices are added to those of the mesh.
// Few triangles have none, as they cost nothing, nor has what is painted: with a texture, or in
// several colours.
// Method: edges that collapse by quadric errors (meshoptimizer).
std::vector<MeshLevel> add_levels(Mesh& mesh, const SurfaceMesh::Patch& patch);

}  // namespace tw
