// The feature of a polyhedron that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/nearest-to-point.h"

#include <algorithm>

namespace tw {

bool over_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point, double slack) {
  for (int i = 0; i < face.count; ++i) {
    const Polyhedron::Side& side = p.side(face.first + i);
    if (side.inward.dot(point) < side.offset - slack) return false;
  }
  return true;
}

Vec3 nearest_on_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point) {
  const Vec3 foot = point - (face.normal.dot(point) - face.offset) * face.normal;
  if (over_face(p, face, foot, 0)) return foot;
  Vec3 best = foot;
  double least = 1e300;
  for (int i = 0; i < face.count; ++i) {
    const Vec3& tail = p.vertex(p.corner(face.first + i));
    const Vec3 along = p.vertex(p.corner(face.first + (i + 1) % face.count)) - tail;
    const double t = std::clamp((foot - tail).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec3 there = tail + t * along;
    const double square = (foot - there).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    best = there;
  }
  return best;
}

NearestToPoint nearest_edge(const Polyhedron& p, const Vec3& point) {
  NearestToPoint best;
  double least = 1e300;
  for (std::size_t e = 0; e < p.edges().size(); ++e) {
    const Polyhedron::Edge& edge = p.edges()[e];
    const Vec3& tail = p.vertex(edge.tail);
    const Vec3 along = p.vertex(edge.head) - tail;
    const double t = std::clamp((point - tail).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vec3 foot = t < 1 ? Vec3(tail + t * along) : p.vertex(edge.head);
    const double square = (point - foot).squaredNorm();
    if (!(square < least)) continue;
    least = square;
    best.point = foot;
    const bool inner = t > 0 && t < 1;
    best.kind = inner ? ContactFeature::line : ContactFeature::point;
    best.direction = along.normalized();
    best.number = inner ? e : static_cast<std::size_t>(t > 0 ? edge.head : edge.tail);
  }
  best.distance = std::sqrt(least);
  best.normal = (point - best.point) / best.distance;
  return best;
}

NearestToPoint nearest_to_point(const Polyhedron& p, const Vec3& point) {
  int number = 0;
  const double height = p.face_separation(point, number);
  const Polyhedron::Face& face = p.face(number);
  // below this distance, relative to the size, a point counts as inside
  constexpr double inside_ratio = 1e-9;
  // the greatest height over a face plane is the distance where the foot lies in the face
  const bool inside = height <= inside_ratio * p.radius();
  if (!inside && !over_face(p, face, point, 0)) return nearest_edge(p, point);
  NearestToPoint result;
  result.normal = face.normal;
  result.point = point - height * face.normal;
  result.distance = height;
  result.number = static_cast<std::uint64_t>(number);
  return result;
}

}  // namespace tw
