// How two polyhedra lie: signed distance, axis, and features.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/nearest-features.h"

#include <utility>

#include "collision/distance/axis-climb.h"
#include "collision/distance/gjk.h"
#include "collision/distance/part-pairs.h"
#include "collision/distance/sat.h"

namespace tw {

namespace {

// The different vertices among those of a simplex, ascending.
CoreFeature spanned(int count, const std::array<int, 4>& vertices) {
  CoreFeature feature;
  for (int i = 0; i < count && feature.count < 3; ++i) {
    int v = vertices[static_cast<std::size_t>(i)];
    const std::size_t size = static_cast<std::size_t>(feature.count);
    bool known = false;
    for (std::size_t k = 0; k < size; ++k) known = known || feature.vertex[k] == v;
    if (known) continue;
    for (std::size_t k = 0; k < size; ++k)
      if (v < feature.vertex[k]) std::swap(v, feature.vertex[k]);
    feature.vertex[size] = v;
    ++feature.count;
  }
  return feature;
}

CoreFeature edge_feature(const Polyhedron& p, int number) {
  const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(number)];
  return {2, {edge.tail, edge.head, 0}, -1};
}

}  // namespace

NearestFeatures nearest_on_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                                const LeastAxis& axis) {
  NearestFeatures result;
  result.distance = axis.distance;
  result.normal = axis.normal;
  if (axis.kind == AxisKind::edges) {
    result.a = edge_feature(a, axis.feature_a);
    result.b = edge_feature(b, axis.feature_b);
    const Vec3& p = a.vertex(result.a.vertex[0]);
    const Vec3 q = b_in_a * b.vertex(result.b.vertex[0]);
    nearest_on_segments(p, a.vertex(result.a.vertex[1]) - p, q,
                        b_in_a * b.vertex(result.b.vertex[1]) - q, result.point_a, result.point_b);
  } else if (axis.kind == AxisKind::face_a) {
    result.a.face = axis.feature_a;
    result.b = {1, {axis.feature_b, 0, 0}, -1};
    result.point_b = b_in_a * b.vertex(axis.feature_b);
    result.point_a = result.point_b - axis.distance * axis.normal;
  } else {
    result.b.face = axis.feature_b;
    result.a = {1, {axis.feature_a, 0, 0}, -1};
    result.point_a = a.vertex(axis.feature_a);
    result.point_b = result.point_a + axis.distance * axis.normal;
  }
  return result;
}

NearestFeatures nearest_of_simplex(const CoreDistance& distance, const SimplexCache& simplex) {
  NearestFeatures result;
  result.distance = distance.distance;
  result.normal = distance.normal;
  result.a = spanned(simplex.count, simplex.vertex_a);
  result.b = spanned(simplex.count, simplex.vertex_b);
  result.point_a = distance.point_a;
  result.point_b = distance.point_a + distance.distance * distance.normal;
  return result;
}

NearestFeatures nearest_features(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                                 double reach) {
  const Climb climb = climb_to_axis(a, b, b_in_a);
  if (climb.end == ClimbEnd::apart || climb.end == ClimbEnd::proven)
    return nearest_on_axis(a, b, b_in_a, climb.axis);
  if (climb.end == ClimbEnd::local) {
    const LeastAxis axis = least_axis(a, b, b_in_a, 0, &climb.axis);
    // a positive distance along an axis says no more than that they are apart
    if (axis.distance <= 0) return nearest_on_axis(a, b, b_in_a, axis);
  }
  NearestFeatures result;
  result.distance = climb.axis.distance;
  if (climb.end == ClimbEnd::beyond && result.distance > reach) return result;

  SimplexCache simplex;
  const CoreDistance core = core_distance(a, b, b_in_a, &simplex);
  const double touch = touch_ratio * (a.radius() + b.radius());
  if (core.overlap || core.distance <= touch)
    return nearest_on_axis(a, b, b_in_a,
                           least_axis(a, b, b_in_a, core.overlap ? 0 : core.distance));
  result.distance = core.distance;
  return core.distance > reach ? result : nearest_of_simplex(core, simplex);
}

}  // namespace tw
