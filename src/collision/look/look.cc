// Looks at pairs of any kinds; of two polyhedra, and of balls, warm.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/look/look.h"

#include <vector>

#include "base/work-count.h"
#include "collision/look/look-polyhedra.h"
#include "collision/manifold/manifold-parts.h"

namespace tw {

namespace {

// A point of a manifold as both shapes see it.
LookPoint seen_by_shapes(const ManifoldPoint& p, const Frame& frame_a, const Frame& frame_b) {
  const Frame& of_reference = p.reference_is_a ? frame_a : frame_b;
  const Frame& of_other = p.reference_is_a ? frame_b : frame_a;
  LookPoint point;
  point.reference_is_a = p.reference_is_a;
  point.normal = of_reference.R.transpose() * p.normal;
  point.offset = point.normal.dot(of_reference.to_local(p.reference_point)) + p.reference_radius;
  point.core = of_other.to_local(p.core_point);
  point.radius = p.radius;
  point.gap = p.gap;
  point.feature = p.feature;
  return point;
}

}  // namespace

void look_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
             double reach, ReferenceChoice choice, PairMemory& memory, PartLook& look) {
  ++work_count.distance_queries;
  look.count = 0;
  look.on_face = false;
  look.room = 0;
  if (a.kind == PartKind::polyhedron && b.kind == PartKind::polyhedron)
    return look_at_polyhedra(a, frame_a, b, frame_b, reach, choice, memory, look);
  thread_local std::vector<ManifoldPoint> points;
  points.clear();
  part_manifold(a, frame_a, b, frame_b, reach, choice, 0, points);
  look.distance = reach;
  look.axis.setZero();
  if (points.empty()) {
    const Separation apart = part_separation(a, frame_a, b, frame_b, nullptr);
    look.distance = apart.distance;
    look.axis = apart.normal;
  }
  for (const ManifoldPoint& p : points) {
    look.distance = std::min(look.distance, p.gap);
    look.add(seen_by_shapes(p, frame_a, frame_b));
  }
}

}  // namespace tw
