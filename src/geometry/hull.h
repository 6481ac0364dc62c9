// The convex hull of points as a polyhedron.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/polyhedron.h"

namespace tw {

// The convex hull, coplanar facets joined to polygons.  A function of the list of points alone:
// vertices keep the order of the points, faces are ordered by their vertices.  Where points lie so
// close that the joined facets would bend, the vertices are the points on a grid, of 1e-9 to 6e-5
// of the size, the finest that does.  Raises UserError on fewer than 4 points, numbers that are not
// finite, and points that are flat (thinner than 1e-9 of their extent), saying how flat.
Polyhedron convex_hull(const std::vector<Vec3>& points);

}  // namespace tw
