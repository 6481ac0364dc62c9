// Contact manifolds: spheres, and the table of pairs of kinds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/manifold.h"

#include <algorithm>

#include "base/constants.h"
#include "base/work-count.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/nearest-to-point.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold-parts.h"
#include "math/aabb.h"

namespace tw {

void ManifoldPoint::follow_lines(const Vec3& of_reference, const Vec3& of_other) {
  const Vec3 along = of_reference.normalized(), other_along = of_other.normalized();
  if (!(along.cross(other_along).squaredNorm() >= patch::crossing * patch::crossing)) return;
  kind = ContactFeature::crossing;
  direction = along;
  other_direction = other_along;
}

void polyhedron_sphere_manifold(const ConvexPart& polyhedron, const Frame& frame_p,
                                const ConvexPart& sphere, const Frame& frame_s, double reach,
                                bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  const Frame world = polyhedron.in(frame_p);
  ManifoldPoint p;
  p.core_point = frame_s * sphere.placement().p;
  const NearestToPoint near = nearest_to_point(*polyhedron.core, world.to_local(p.core_point));
  p.gap = near.distance - sphere.radius;
  if (p.gap > reach) return;
  p.reference_is_a = reference_is_a;
  p.kind = near.kind;
  p.normal = world.R * near.normal;
  p.direction = world.R * near.direction;
  p.reference_point = world * near.point;
  p.radius = sphere.radius;
  p.pair = pair;
  constexpr FeatureMode modes[] = {FeatureMode::face, FeatureMode::edge, FeatureMode::vertex};
  p.feature = feature_name(pair, modes[static_cast<int>(near.kind)], {near.number, 0, 0});
  out.push_back(p);
}

namespace {

void half_space_sphere_manifold(const ConvexPart& half_space, const Frame& frame_h,
                                const ConvexPart& sphere, const Frame& frame_s, double reach,
                                bool reference_is_a, int pair, std::vector<ManifoldPoint>& out) {
  ManifoldPoint p;
  p.core_point = frame_s * sphere.placement().p;
  p.normal = frame_h.R * half_space.normal;
  const double height = p.normal.dot(p.core_point - frame_h.p) - half_space.offset;
  p.gap = height - sphere.radius;
  if (p.gap > reach) return;
  p.reference_is_a = reference_is_a;
  p.reference_point = p.core_point - height * p.normal;
  p.radius = sphere.radius;
  p.pair = pair;
  p.feature = feature_name(pair, FeatureMode::half_space, {0, 0, 0});
  out.push_back(p);
}

}  // namespace

void spheres_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                      const Frame& frame_b, double reach, int pair,
                      std::vector<ManifoldPoint>& out) {
  ManifoldPoint p;
  p.reference_point = frame_a * a.placement().p;
  p.core_point = frame_b * b.placement().p;
  const Vec3 apart = p.core_point - p.reference_point;
  const double length = apart.norm();
  p.gap = length - (a.radius + b.radius);
  if (p.gap > reach) return;
  p.kind = ContactFeature::point;
  // concentric: any direction
  if (length > 0) p.normal = apart / length;
  p.reference_radius = a.radius;
  p.radius = b.radius;
  p.pair = pair;
  p.feature = feature_name(pair, FeatureMode::ball, {0, 0, 0});
  out.push_back(p);
}

void round_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                    const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                    std::vector<ManifoldPoint>& out) {
  const bool smooth = a.kind == PartKind::ellipsoid || b.kind == PartKind::ellipsoid;
  (smooth ? ellipsoid_manifold_at : frustum_manifold_at)(a, frame_a, b, frame_b, near, reach, pair,
                                                         out);
}

void lie_on_each_other(double parallel, double steepest, std::vector<FacePoint>& higher,
                       std::size_t from, std::vector<ManifoldPoint>& out) {
  const std::size_t here = out.size() - from;
  if (here == 0 || here + higher.size() < 2 || !(parallel > 0)) return;
  thread_local std::vector<FacePoint> points;
  points.clear();
  Aabb extent;
  double lowest = 1e300;
  for (std::size_t i = from; i < out.size(); ++i) {
    const ManifoldPoint& p = out[i];
    points.push_back({p.core_point - p.radius * p.normal, p.gap});
    extent.add(points.back().point);
    lowest = std::min(lowest, p.gap);
  }
  for (const FacePoint& p : higher) extent.add(p.point);
  const double slack = patch::as_low * extent.size().norm();
  // the steepest slope down to one of the lowest counts
  const auto flatness = [&](const FacePoint& p) {
    double flat = 1;
    for (const FacePoint& low : points) {
      const double weight = 1 - (low.gap - lowest) / slack, height = p.gap - low.gap;
      if (!(weight > 0 && height > 0)) continue;
      flat = std::min(flat, 1 - weight * height / (steepest * (p.point - low.point).norm()));
    }
    return std::max(flat, 0.0) * parallel;
  };
  const auto lower = [](const FacePoint& p, const FacePoint& q) { return p.gap < q.gap; };
  const std::size_t room = patch::most_points - std::min(here, patch::most_points);
  if (higher.size() > room) {
    std::partial_sort(higher.begin(), higher.begin() + static_cast<std::ptrdiff_t>(room),
                      higher.end(), lower);
    higher.resize(room);
  }
  double beyond = 0;
  for (const FacePoint& p : higher) beyond += flatness(p);
  for (std::size_t i = from; i < out.size(); ++i) {
    out[i].flatness = flatness(points[i - from]);
    out[i].beyond = beyond / static_cast<double>(here);
  }
}

void part_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                   const Frame& frame_b, double reach, ReferenceChoice choice, int pair,
                   std::vector<ManifoldPoint>& out) {
  ++work_count.distance_queries;
  using K = PartKind;
  const auto are = [&](K first, K second) { return a.kind == first && b.kind == second; };
  if (are(K::polyhedron, K::polyhedron))
    return polyhedra_manifold(a, frame_a, b, frame_b, reach, choice, pair, out);
  if (are(K::half_space, K::polyhedron))
    return half_space_manifold(a, frame_a, b, frame_b, reach, true, pair, out);
  if (are(K::polyhedron, K::half_space))
    return half_space_manifold(b, frame_b, a, frame_a, reach, false, pair, out);
  if (are(K::polyhedron, K::sphere))
    return polyhedron_sphere_manifold(a, frame_a, b, frame_b, reach, true, pair, out);
  if (are(K::sphere, K::polyhedron))
    return polyhedron_sphere_manifold(b, frame_b, a, frame_a, reach, false, pair, out);
  if (are(K::half_space, K::sphere))
    return half_space_sphere_manifold(a, frame_a, b, frame_b, reach, true, pair, out);
  if (are(K::sphere, K::half_space))
    return half_space_sphere_manifold(b, frame_b, a, frame_a, reach, false, pair, out);
  if (are(K::sphere, K::sphere)) return spheres_manifold(a, frame_a, b, frame_b, reach, pair, out);
  if (a.kind == K::ellipsoid || b.kind == K::ellipsoid)
    return ellipsoid_manifold(a, frame_a, b, frame_b, reach, pair, out);
  if (a.kind == K::frustum || b.kind == K::frustum)
    return frustum_manifold(a, frame_a, b, frame_b, reach, pair, out);
  // two half-spaces touch in a plane, which no few points describe
}

void manifold(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
              double reach, std::vector<ManifoldPoint>& out, ReferenceChoice choice) {
  visit_near_parts(a, frame_a, b, frame_b, reach, [&](std::size_t i, std::size_t j) {
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    part_manifold(a.part(i), frame_a, b.part(j), frame_b, reach, choice, pair_number(i, j, b), out);
    std::sort(out.begin() + first, out.end(),
              [](const auto& p, const auto& q) { return p.feature < q.feature; });
  });
}

}  // namespace tw
