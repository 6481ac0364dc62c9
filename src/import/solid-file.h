// Solids from mesh files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/shape.h"

namespace tw {

// The shape of an OBJ file (coordinates as they are written) or of any other that Assimp reads, STL
// among them: a hull, or the union of the hulls of what hangs together in it by common vertices,
// object by object in the file's order.  Coordinates are multiplied by `scale`, which gives metres.
//
// Errors: UserError, with the file's name, where it is missing, is no mesh, or is flat; and with
// the name of the object where one is not convex, by more than 1e-4 of its size, unless `hulls`
// says that its hull is wanted all the same.
ShapePtr read_solid(const std::string& file, const Vec3& scale, bool hulls);

}  // namespace tw
