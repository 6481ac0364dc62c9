// A pair of convex parts in contact at a seam of one of them, and which of their contacts are
// ghosts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "base/constants.h"
#include "collision/manifold/manifold-parts.h"
#include "collision/seams/seams.h"

namespace tw {

// One body with what surrounds its parts.
struct SeamSide {
  const Shape& shape;
  const Frame& frame;
  const std::vector<SeamNeighbour>& around;
  bool has_seams;

  SeamSide(const Shape& s, const Frame& f, const std::vector<SeamNeighbour>& neighbours)
      : shape(s),
        frame(f),
        around(neighbours),
        has_seams(!neighbours.empty() || s.part_count() > 1) {}

  // The neighbours of one part whose balls come near its own; of a shape with a tree those whose
  // boxes come near both its own and `where` (world).  Overwrites `out`.
  void neighbours_of(std::size_t part, const Aabb& where, std::vector<SeamNeighbour>& out) const;

 private:
  void add_from_tree(std::size_t part, const Aabb& where, std::vector<SeamNeighbour>& out) const;
};

// How far a part may be from what lies in its neighbours and touches what it goes on by beneath
// them, m.
inline double farthest_touch(const SeamSide& a, const SeamSide& b, double reach, double size) {
  return a.has_seams || b.has_seams ? std::max(reach, seam::sunk * size) : reach;
}

struct SeamPair {
  const SeamSide& a;
  const SeamSide& b;
  std::size_t part_a, part_b;
  double reach, size;
  ReferenceChoice choice;
  int pair;
  // the neighbours of the part of a and of b, once they are asked for
  std::vector<SeamNeighbour>* lists[2];
  mutable bool listed[2] = {false, false};

  const ConvexPart& first() const { return a.shape.part(part_a); }
  const ConvexPart& second() const { return b.shape.part(part_b); }

  double farthest() const { return farthest_touch(a, b, reach, size); }

  const std::vector<SeamNeighbour>& neighbours(bool of_a) const;

  // Whether the neighbours of a's part (or b's) bury the point; the normal is from a to b, world.
  bool buries(bool on_a, const Vec3& point, const Vec3& normal, double angle,
              double depth = 0) const;
  bool is_ghost(const ManifoldPoint& p, double angle) const;
  void remove_ghosts(std::size_t from, double angle, std::vector<ManifoldPoint>& out) const;
};

// Two polyhedra; a frustum or ellipsoid and a polyhedron or another of these.  They return the
// distance, with all ghosts, or beyond the reach a lower bound of it.
double polyhedra_at_seam(const SeamPair& pair, std::vector<ManifoldPoint>& out);
double round_at_seam(const SeamPair& pair, std::vector<ManifoldPoint>& out);

// Where the neighbours bury the axis of least depth of a polyhedron and a round part: the edges of
// the polyhedron, which is a's (or b's), as far as they are exposed, and what they go on by beneath
// neighbours beside their ends.
void round_at_edges(const SeamPair& pair, bool of_a, std::vector<ManifoldPoint>& out);

}  // namespace tw
