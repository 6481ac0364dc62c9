// Ghosts of a pair of parts; see the header.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/seams/seam-pair.h"
#include "collision/seams/seams.h"

#include <algorithm>

#include "collision/broad/near-parts.h"

namespace tw {

void SeamSide::neighbours_of(std::size_t part, const Aabb& where,
                             std::vector<SeamNeighbour>& out) const {
  out.clear();
  const ConvexPart& here = shape.part(part);
  const Vec3 center = frame * here.bound_center;
  const auto add = [&](const SeamNeighbour& q) {
    const double near = (q.part->bound_radius + here.bound_radius) * (1 + 1e-6);
    const bool apart = (q.frame * q.part->bound_center - center).squaredNorm() > near * near;
    if (!apart) out.push_back(q);
  };
  if (shape.tree())
    add_from_tree(part, where, out);
  else
    for (std::size_t i = 0; i < shape.part_count(); ++i)
      if (i != part) add({&shape.part(i), frame});
  for (const SeamNeighbour& q : around) add(q);
}

void SeamSide::add_from_tree(std::size_t part, const Aabb& where,
                             std::vector<SeamNeighbour>& out) const {
  Aabb here = part_bounds(shape.part(part), Frame());
  here.grow(1e-6 * here.size().maxCoeff());
  const Aabb there = seen_from(frame, where);
  thread_local std::vector<std::uint32_t> near;
  parts_in(shape, {here.lo.cwiseMax(there.lo), here.hi.cwiseMin(there.hi)}, near);
  for (const std::uint32_t i : near)
    if (i != part) out.push_back({&shape.part(i), frame});
}

const std::vector<SeamNeighbour>& SeamPair::neighbours(bool of_a) const {
  const std::size_t side = of_a ? 0 : 1;
  if (listed[side]) return *lists[side];
  Aabb where;
  if ((of_a ? a : b).shape.tree()) {
    where = of_a ? part_bounds(second(), b.frame) : part_bounds(first(), a.frame);
    where.grow(farthest() + 2 * seam::probe * size);
  }
  (of_a ? a : b).neighbours_of(of_a ? part_a : part_b, where, *lists[side]);
  listed[side] = true;
  return *lists[side];
}

bool SeamPair::buries(bool on_a, const Vec3& point, const Vec3& normal, double angle,
                      double depth) const {
  const SeamSide& side = on_a ? a : b;
  if (!side.has_seams) return false;
  // whatever stands out of a half-space makes a valley with it: what is in both touches both
  const ConvexPart& part = on_a ? first() : second();
  if (part.kind == PartKind::half_space) return false;
  return buried_edge(part, side.frame, point, on_a ? normal : Vec3(-normal), neighbours(on_a), size,
                     angle, depth);
}

bool SeamPair::is_ghost(const ManifoldPoint& p, double angle) const {
  const Vec3 on_reference = p.reference_point + p.reference_radius * p.normal;
  const Vec3 on_other = p.core_point - p.radius * p.normal;
  const Vec3 normal = p.reference_is_a ? p.normal : Vec3(-p.normal);
  return buries(p.reference_is_a, on_reference, normal, angle, -p.gap) ||
         buries(!p.reference_is_a, on_other, normal, angle, -p.gap);
}

void SeamPair::remove_ghosts(std::size_t from, double angle,
                             std::vector<ManifoldPoint>& out) const {
  const auto ghosts = std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(from), out.end(),
                                     [&](const ManifoldPoint& p) { return is_ghost(p, angle); });
  out.erase(ghosts, out.end());
}

}  // namespace tw
