// What is seen of mesh files: triangles with normals, colours and textures of their materials.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "geometry/visual.h"
#include "import/mending.h"

namespace tw {

// Of any file that Assimp reads (OBJ with its mtl, STL, Collada and others), with the transforms of
// its scene applied; coordinates are multiplied by `scale`, which gives metres.  `y_up`: the file's
// y is up: it becomes z, and its z becomes -y.  Normals are the file's; where it has none, or those
// of an STL, edges sharper than 40 degrees stay sharp.  What has a texture is white beneath it; one
// that is missing or cannot be read is mended by the colour of its material.
//
// Errors: UserError, with the file's name, where it is missing, is no mesh, or has no triangles.
std::shared_ptr<const SurfaceMesh> read_surface(const std::string& file, const Vec3& scale,
                                                bool y_up, Mending& mending);

}  // namespace tw
