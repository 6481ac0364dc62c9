// Parts of mesh files that are not convex: solids with their cavities, as convex pieces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/shape.h"
#include "import/mending.h"

namespace tw {

// The triangles of one object; points that are no corner of any don't count.
struct MeshObject {
  std::string name;
  std::vector<std::array<std::size_t, 3>> triangles;
};

// Each side of a triangle is, the other way round, that of another.
bool is_closed(const std::vector<std::array<std::size_t, 3>>& triangles);

// Of what is closed; less than 0 where its triangles face inwards.
double volume_within(const MeshObject& object, const std::vector<Vec3>& points);

// Of each part the one that it is a cavity of: closed, in the other and nothing smaller, and facing
// the other way.  What is in a cavity is a solid again.
std::vector<std::optional<std::size_t>> hosts_of_cavities(const std::vector<MeshObject>& parts,
                                                          const std::vector<Vec3>& points);

// Part `part` without its cavities (import/convex-pieces.h); `what` it is begins what is told.
ShapePtr decomposed(const std::string& what, std::size_t part, const std::vector<MeshObject>& parts,
                    const std::vector<Vec3>& points,
                    const std::vector<std::optional<std::size_t>>& hosts, std::size_t most,
                    Mending& mending);

}  // namespace tw
