// Overlap along one direction.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/overlap-along.h"

#include <limits>

#include "geometry/polyhedron.h"

namespace tw {
namespace {

bool is_polyhedron(const Shape& shape) {
  return shape.part_count() == 1 && shape.part(0).kind == PartKind::polyhedron;
}

// How far a placed polyhedron reaches along the direction, m from the origin.
double reach(const Vec3& direction, const Shape& shape, const Frame& frame) {
  const ConvexPart& part = shape.part(0);
  const Frame place = part.in(frame);
  return direction.dot(place.p) + part.core->extent(place.R.transpose() * direction, 0);
}

}  // namespace

double overlap_along(const Vec3& normal, const Shape& a, const Frame& frame_a, const Shape& b,
                     const Frame& frame_b) {
  if (!is_polyhedron(a) || !is_polyhedron(b)) return std::numeric_limits<double>::infinity();
  return reach(normal, a, frame_a) + reach(-normal, b, frame_b);
}

}  // namespace tw
