// The points where two placed shapes touch.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "base/constants.h"
#include "base/work-count.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/gjk.h"
#include "collision/manifold/clip.h"
#include "collision/manifold/manifold-parts.h"

namespace tw {

void crossing_of_edges(const CorePair& pair, const LeastAxis& axis, Vec3& on_a, Vec3& on_b) {
  const auto& edge_a = pair.a.edges()[static_cast<std::size_t>(axis.feature_a)];
  const auto& edge_b = pair.b.edges()[static_cast<std::size_t>(axis.feature_b)];
  const Vec3& p = pair.a.vertex(edge_a.tail);
  const Vec3 q = pair.b_in_a * pair.b.vertex(edge_b.tail);
  nearest_on_segments(p, pair.a.vertex(edge_a.head) - p, q,
                      pair.b_in_a * pair.b.vertex(edge_b.head) - q, on_a, on_b);
}

namespace {

// Face of A or B as reference: the other's face clipped by it.
void face_points(const CorePair& cores, const LeastAxis& axis, double tolerance,
                 std::vector<ClippedPoint>& points) {
  if (axis.kind == AxisKind::face_a) {
    clip_face(cores.a, axis.feature_a, cores.b, cores.b_in_a, axis.feature_b, tolerance,
              patch::most_points, points);
    // midway between the surfaces
    for (ClippedPoint& p : points) p.point -= 0.5 * p.gap * axis.normal;
    return;
  }
  clip_face(cores.b, axis.feature_b, cores.a, cores.a_in_b(), axis.feature_a, tolerance,
            patch::most_points, points);
  for (ClippedPoint& p : points) p.point = cores.b_in_a * p.point + 0.5 * p.gap * axis.normal;
}

// The one point of two corners: midway between the nearest points where the cores are apart, else
// the corner that is deepest along the axis.
ClippedPoint corner_point(const CorePair& cores, const LeastAxis& axis, const CoreDistance& apart) {
  if (!apart.overlap) return {apart.point_a + 0.5 * apart.distance * apart.normal, apart.distance};
  const Vec3 inward = 0.5 * axis.distance * axis.normal;
  if (axis.kind == AxisKind::face_a)
    return {cores.b_in_a * cores.b.vertex(axis.feature_b) - inward, axis.distance};
  return {cores.a.vertex(axis.feature_a) + inward, axis.distance};
}

void polyhedra_points(const CorePair& cores, double tolerance, int pair,
                      std::vector<ContactPoint>& out) {
  thread_local std::vector<ClippedPoint> points;
  const CoreDistance apart = core_distance(cores.a, cores.b, cores.b_in_a, nullptr);
  if (!apart.overlap && apart.distance > tolerance) return;
  const LeastAxis axis =
      least_axis(cores.a, cores.b, cores.b_in_a, apart.overlap ? 0 : apart.distance);
  if (axis.distance > tolerance) return;
  points.clear();
  if (axis.kind == AxisKind::edges) {
    Vec3 on_a, on_b;
    crossing_of_edges(cores, axis, on_a, on_b);
    points.push_back({0.5 * (on_a + on_b), axis.normal.dot(on_b - on_a)});
  } else {
    face_points(cores, axis, tolerance, points);
  }
  // two corners may have no face between them: the nearest points
  if (points.empty()) points.push_back(corner_point(cores, axis, apart));
  const Vec3 normal = cores.world_a.R * axis.normal;
  for (const ClippedPoint& p : points)
    out.push_back({cores.world_a * p.point, normal, p.gap, pair});
}

// The vertices of a polyhedron near a half-space; `sign` is 1 where the half-space is A, else -1.
void half_space_points(const ConvexPart& half_space, const Frame& frame_h,
                       const ConvexPart& polyhedron, const Frame& frame_p, double tolerance,
                       double sign, int pair, std::vector<ContactPoint>& out) {
  thread_local std::vector<ClippedPoint> points;
  ++work_count.distance_queries;
  const Vec3 normal = frame_h.R * half_space.normal;
  const Frame world = polyhedron.in(frame_p);
  points.clear();
  for (const Vec3& v : polyhedron.core->vertices()) {
    const Vec3 point = world * v;
    const double gap = normal.dot(point - frame_h.p) - half_space.offset;
    if (gap <= tolerance) points.push_back({point, gap});
  }
  thin_points(points, patch::most_points);
  for (const ClippedPoint& p : points)
    out.push_back({p.point - 0.5 * p.gap * normal, sign * normal, p.gap, pair});
}

// The manifold of a frustum, midway between the surfaces.
void frustum_points(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                    const Frame& frame_b, double tolerance, int pair,
                    std::vector<ContactPoint>& out) {
  thread_local std::vector<ManifoldPoint> points;
  points.clear();
  ++work_count.distance_queries;
  frustum_manifold(a, frame_a, b, frame_b, tolerance, pair, points);
  for (const ManifoldPoint& p : points) {
    const Vec3 surface = p.core_point - (p.radius + 0.5 * p.gap) * p.normal;
    out.push_back({surface, p.reference_is_a ? p.normal : Vec3(-p.normal), p.gap, pair});
  }
}

void part_points(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                 const Frame& frame_b, double tolerance, int pair, std::vector<ContactPoint>& out) {
  if (a.kind == PartKind::polyhedron && b.kind == PartKind::polyhedron) {
    ++work_count.distance_queries;
    return polyhedra_points(CorePair(a, frame_a, b, frame_b), tolerance, pair, out);
  }
  // two half-spaces touch in a plane, which no few points describe
  if (a.kind == PartKind::half_space && b.kind == PartKind::half_space) return;
  if (a.kind == PartKind::half_space && b.kind == PartKind::polyhedron)
    return half_space_points(a, frame_a, b, frame_b, tolerance, 1, pair, out);
  if (b.kind == PartKind::half_space && a.kind == PartKind::polyhedron)
    return half_space_points(b, frame_b, a, frame_a, tolerance, -1, pair, out);
  const auto is_curved = [](const ConvexPart& part) {
    return part.kind == PartKind::sphere || part.kind == PartKind::ellipsoid;
  };
  if (!is_curved(a) && !is_curved(b))
    return frustum_points(a, frame_a, b, frame_b, tolerance, pair, out);
  // what is curved all over touches in one point
  const Separation s = part_separation(a, frame_a, b, frame_b, nullptr);
  if (s.distance <= tolerance)
    out.push_back({0.5 * (s.point_a + s.point_b), s.normal, s.distance, pair});
}

}  // namespace

void touching_points(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
                     double tolerance, std::vector<ContactPoint>& out) {
  visit_near_parts(a, frame_a, b, frame_b, tolerance, [&](std::size_t i, std::size_t j) {
    part_points(a.part(i), frame_a, b.part(j), frame_b, tolerance, pair_number(i, j, b), out);
  });
}

}  // namespace tw
