// The convex cells of a solid, joined to fewer convex pieces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/polyhedron.h"

namespace tw {

// Hulls of cells, that go on beyond the surface of all cells by at most `height`, m, along its
// normal: at the middles of four parts of each triangle of a cell's face that no other cell lies
// behind.  Pairs join first that add least.
//
// It is given up where this thread is (base/interruption.h).
std::vector<Polyhedron> joined_cells(const std::vector<Polyhedron>& cells, double height);

}  // namespace tw
