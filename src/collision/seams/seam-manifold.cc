// Contact manifolds without ghosts at seams: the table of pairs of kinds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "base/constants.h"
#include "collision/broad/near-parts.h"
#include "collision/seams/seam-pair.h"
#include "collision/seams/seams.h"

namespace tw {

namespace {

double add(const SeamPair& seam, std::vector<ManifoldPoint>& out) {
  const PartKind first = seam.first().kind, second = seam.second().kind;
  const auto has_core = [](PartKind kind) {
    return kind == PartKind::polyhedron || kind == PartKind::frustum || kind == PartKind::ellipsoid;
  };
  if (first == PartKind::polyhedron && second == PartKind::polyhedron)
    return polyhedra_at_seam(seam, out);
  if (has_core(first) && has_core(second)) return round_at_seam(seam, out);
  const std::size_t from = out.size();
  part_manifold(seam.first(), seam.a.frame, seam.second(), seam.b.frame, seam.reach, seam.choice,
                seam.pair, out);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i < out.size(); ++i) least = std::min(least, out[i].gap);
  seam.remove_ghosts(from, seam::same_angle, out);
  return least;
}

// The pair of parts that are deepest in each other.
struct Deepest {
  std::size_t first = 0, second = 0;
  double distance = std::numeric_limits<double>::infinity();
};

}  // namespace

double manifold_at_seams(const Shape& a, const Frame& frame_a,
                         const std::vector<SeamNeighbour>& around_a, const Shape& b,
                         const Frame& frame_b, const std::vector<SeamNeighbour>& around_b,
                         double reach, double size, std::vector<ManifoldPoint>& out,
                         ReferenceChoice choice) {
  const SeamSide side_a(a, frame_a, around_a);
  const SeamSide side_b(b, frame_b, around_b);
  thread_local std::vector<SeamNeighbour> near_a, near_b;
  Deepest deepest;
  const std::size_t before = out.size();
  const auto add_pair = [&](std::size_t i, std::size_t j) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    const SeamPair seam{
        side_a, side_b, i, j, reach, size, choice, pair_number(i, j, b), {&near_a, &near_b}};
    const double distance = add(seam, out);
    if (distance <= reach && distance < deepest.distance) deepest = {i, j, distance};
    std::sort(out.begin() + first, out.end(),
              [](const auto& p, const auto& q) { return p.feature < q.feature; });
  };
  visit_near_parts(a, frame_a, b, frame_b, farthest_touch(side_a, side_b, reach, size), add_pair);
  // A net: what stands alone does not bury all that a body is in.  It held the balls that fell
  // through where round parts meet flush before that was known; nothing else is known to need it.
  if (out.size() == before && around_a.empty() && around_b.empty() &&
      deepest.distance < -seam::low * size)
    part_manifold(a.part(deepest.first), frame_a, b.part(deepest.second), frame_b, reach, choice,
                  pair_number(deepest.first, deepest.second, b), out);
  return deepest.distance;
}

}  // namespace tw
