// Described polyhedra by way of mesh files.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "fuzz/described-scene.h"

namespace tw::fuzz {

// What the program reads from a file of obj_text.
ShapePtr shape_from_file(const DescribedBody& body);

}  // namespace tw::fuzz
