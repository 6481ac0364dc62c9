// The points where a face of one polyhedron lies on the other polyhedron.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/clip.h"

#include <algorithm>

namespace tw {

namespace {

// corners this near a side plane, relative to the size, lie on it: faces of equal outline would
// otherwise be cut at every corner by rounding
constexpr double on_plane = 1e-12;

// corners this near each other, relative to the size, are one: no impulse could tell them apart
constexpr double coincident = 1e-8;

// Keeps the part of the polygon with inward.x >= offset, up to `slack` beyond.
void clip_by_plane(std::vector<Vec3>& polygon, const Vec3& inward, double offset, double slack) {
  thread_local std::vector<Vec3> kept;
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& here = polygon[i];
    const Vec3& next = polygon[(i + 1) % polygon.size()];
    const double height = inward.dot(here) - offset;
    const double next_height = inward.dot(next) - offset;
    const bool inside = height >= -slack;
    if (inside) kept.push_back(here);
    if (inside != (next_height >= -slack))
      // both may lie beyond, one within the slack: then the crossing is at that one's end
      kept.push_back(here + (next - here) * std::clamp(height / (height - next_height), 0.0, 1.0));
  }
  polygon.swap(kept);
}

// Adds a point unless it coincides with one that is there; of the two the deeper stays.
void add_point(std::vector<ClippedPoint>& points, const ClippedPoint& fresh, double slack) {
  for (ClippedPoint& old : points)
    if ((old.point - fresh.point).norm() <= slack) {
      if (fresh.gap < old.gap) old = fresh;
      return;
    }
  points.push_back(fresh);
}

}  // namespace

void clip_face(const Polyhedron& reference, int face_number, const Polyhedron& other,
               const Frame& other_in_reference, int deepest, double tolerance, std::size_t most,
               std::vector<ClippedPoint>& out) {
  thread_local std::vector<Vec3> polygon;
  const Polyhedron::Face& face = reference.face(face_number);
  const Vec3 against = -(other_in_reference.R.transpose() * face.normal);
  const Polyhedron::Face& incident = other.face(other.face_at_vertex(deepest, against));
  polygon.clear();
  for (int i = 0; i < incident.count; ++i)
    polygon.push_back(other_in_reference * other.vertex(other.corner(incident.first + i)));

  // the sides of the reference face, inward normals square to its plane
  const double size = reference.radius() + other.radius();
  for (int i = 0; i < face.count && !polygon.empty(); ++i) {
    const Polyhedron::Side& side = reference.side(face.first + i);
    clip_by_plane(polygon, side.inward, side.offset, on_plane * size);
  }

  out.clear();
  for (const Vec3& point : polygon) {
    const double gap = face.normal.dot(point) - face.offset;
    if (gap <= tolerance) add_point(out, {point, gap}, coincident * size);
  }
  thin_points(out, most);
}

void thin_points(std::vector<ClippedPoint>& points, std::size_t most) {
  if (points.size() <= most) return;
  const auto deeper = [](const ClippedPoint& p, const ClippedPoint& q) { return p.gap < q.gap; };
  std::vector<bool> chosen(points.size(), false);
  // squared distance to the nearest chosen point
  std::vector<double> away(points.size(), 1e300);
  auto pick = static_cast<std::size_t>(std::min_element(points.begin(), points.end(), deeper) -
                                       points.begin());
  for (std::size_t n = 0; n < most; ++n) {
    chosen[pick] = true;
    for (std::size_t i = 0; i < points.size(); ++i)
      away[i] =
          chosen[i] ? -1 : std::min(away[i], (points[i].point - points[pick].point).squaredNorm());
    pick = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (chosen[i]) points[kept++] = points[i];
  points.resize(kept);
}

}  // namespace tw
