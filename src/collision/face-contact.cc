// The points where one polyhedron lies on a face of another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/face-contact.h"

#include <algorithm>

#include "base/constants.h"
#include "base/never.h"

namespace tw {

namespace {

// corners this near a side, relative to the size, lie on it: faces of equal outline would otherwise
// be cut at every corner by rounding
constexpr double on_side = 1e-12;

// A vertex by its number; a crossing by the ends of the incident edge and the side; a corner of the
// reference face by its two sides.
std::uint64_t vertex_key(int vertex) { return static_cast<std::uint64_t>(vertex); }

std::uint64_t pair_key(std::uint64_t kind, int first, int second, int third) {
  return kind << 60 | static_cast<std::uint64_t>(first) << 40 |
         static_cast<std::uint64_t>(second) << 20 | static_cast<std::uint64_t>(third);
}

std::uint64_t corner_key(const Polyhedron& p, const Polyhedron::Face& incident, int before,
                         int after) {
  if (before < 0 && after < 0) return pair_key(face_corner, 0, ~before, ~after);
  const int edge = before < 0 ? after : before;
  const int tail = p.corner(incident.first + edge);
  const int head = p.corner(incident.first + (edge + 1) % incident.count);
  // two edges of the incident face meet in the tail of the second
  if (before >= 0 && after >= 0) return vertex_key(p.corner(incident.first + after));
  return pair_key(edge_crossing, std::min(tail, head), std::max(tail, head),
                  ~std::min(before, after));
}

// Adds a point unless it coincides with one that is there: of two vertices or two others the deeper
// stays, of a vertex and another the vertex.
void add_point(std::vector<FacePoint>& points, const FacePoint& fresh, double slack) {
  const auto is_vertex = [](const FacePoint& p) { return p.key >> 60 == vertex_point; };
  for (FacePoint& old : points)
    if (old.key == fresh.key || (old.point - fresh.point).squaredNorm() <= slack * slack) {
      const bool better =
          is_vertex(old) == is_vertex(fresh) ? fresh.gap < old.gap : is_vertex(fresh);
      if (better) old = fresh;
      return;
    }
  points.push_back(fresh);
}

// Half the width of a polygon, m: its area over half its border.
double half_width(const std::vector<FacePoint>& polygon) {
  Vec3 doubled = Vec3::Zero();
  double border = 0;
  const Vec3* before = &polygon.back().point;
  for (const FacePoint& corner : polygon) {
    doubled += (*before - polygon[0].point).cross(corner.point - polygon[0].point);
    border += (corner.point - *before).norm();
    before = &corner.point;
  }
  return border > 0 ? doubled.norm() / border : 0;
}

// How far a corner lies off the line that joins its neighbours; never, if it is deeper than that by
// more than `below`.
double sticks_out(const FacePoint& before, const FacePoint& corner, const FacePoint& after,
                  double below) {
  const Vec3 line = after.point - before.point, to = corner.point - before.point;
  const double squared = line.squaredNorm();
  const double t = squared > 0 ? std::clamp(to.dot(line) / squared, 0.0, 1.0) : 0;
  if (corner.gap < before.gap + t * (after.gap - before.gap) - below) return never;
  return (to - t * line).norm();
}

// Leaves out corners that hardly stick out, the least first.
void straighten(std::vector<FacePoint>& polygon, double below,
                std::vector<std::uint64_t>& left_out) {
  if (polygon.size() <= 3) return;
  const double aside = patch::straight * half_width(polygon);
  while (polygon.size() > 3) {
    double least = aside;
    std::size_t which = polygon.size();
    for (std::size_t i = 0, last = polygon.size() - 1; i <= last; ++i) {
      const double off = sticks_out(polygon[i > 0 ? i - 1 : last], polygon[i],
                                    polygon[i < last ? i + 1 : 0], below);
      if (off >= least) continue;
      least = off;
      which = i;
    }
    if (which == polygon.size()) return;
    left_out.push_back(polygon[which].key);
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(which));
  }
}

// How far a point lies beside the face, by its sides: negative over it.
double beside(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point) {
  double most = -1e300;
  for (int i = 0; i < face.count; ++i) {
    const Polyhedron::Side& side = p.side(face.first + i);
    most = std::max(most, side.offset - side.inward.dot(point));
  }
  return most;
}

}  // namespace

void clip_by_side(std::vector<ClipCorner>& polygon, const Polyhedron::Side& side, int number,
                  double slack) {
  thread_local std::vector<ClipCorner> kept;
  kept.clear();
  double here_in = side.inward.dot(polygon[0].point) - side.offset;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClipCorner& here = polygon[i];
    const ClipCorner& next = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double next_in = side.inward.dot(next.point) - side.offset;
    const bool inside = here_in >= -slack;
    if (inside) kept.push_back(here);
    if (inside != (next_in >= -slack)) {
      // both may lie beyond, one within the slack: then the crossing is at that one's end
      const double t = std::clamp(here_in / (here_in - next_in), 0.0, 1.0);
      kept.push_back({here.point + t * (next.point - here.point),
                      here.height + t * (next.height - here.height), inside ? ~number : here.next});
    }
    here_in = next_in;
  }
  polygon.swap(kept);
}

void face_contact(const Polyhedron& reference, int face_number, const Polyhedron& incident,
                  const Frame& incident_in_reference, int incident_number, double reach,
                  std::size_t most, std::vector<FacePoint>& out) {
  thread_local std::vector<ClipCorner> polygon;
  const Polyhedron::Face& face = reference.face(face_number);
  const Polyhedron::Face& incident_face = incident.face(incident_number);
  const double size = reference.radius() + incident.radius();
  const double slack = on_side * size;
  const double near = coincident_ratio * size;
  out.clear();

  // the incident face, cut down to what lies over the reference face
  polygon.clear();
  for (int i = 0; i < incident_face.count; ++i) {
    const Vec3 point =
        incident_in_reference * incident.vertex(incident.corner(incident_face.first + i));
    polygon.push_back({point, face.normal.dot(point) - face.offset, i});
  }
  for (int i = 0; i < face.count && !polygon.empty(); ++i)
    clip_by_side(polygon, reference.side(face.first + i), face.first + i, slack);
  thread_local std::vector<FacePoint> corners;
  thread_local std::vector<std::uint64_t> left_out;
  corners.clear();
  left_out.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const int before = polygon[i > 0 ? i - 1 : polygon.size() - 1].next;
    add_point(corners,
              {polygon[i].point, polygon[i].height,
               corner_key(incident, incident_face, before, polygon[i].next)},
              near);
  }
  straighten(corners, patch::missed_floor * size, left_out);
  for (const FacePoint& corner : corners)
    if (corner.gap <= reach) out.push_back(corner);

  // vertices that may come down
  const Vec3 up = incident_in_reference.R.transpose() * face.normal;
  const double base = face.normal.dot(incident_in_reference.p) - face.offset;
  const int count = static_cast<int>(incident.vertices().size());
  for (int v = 0; v < count; ++v) {
    if (up.dot(incident.vertex(v)) + base > reach) continue;
    const Vec3 point = incident_in_reference * incident.vertex(v);
    const double height = face.normal.dot(point) - face.offset;
    if (!(height <= reach)) continue;
    if (beside(reference, face, point) > std::max(height, slack)) continue;
    if (std::find(left_out.begin(), left_out.end(), vertex_key(v)) != left_out.end()) continue;
    add_point(out, {point, height, vertex_key(v)}, near);
  }
  thin_face_points(out, most);
}

void thin_face_points(std::vector<FacePoint>& points, std::size_t most) {
  if (points.size() <= most) return;
  const auto deeper = [](const FacePoint& p, const FacePoint& q) { return p.gap < q.gap; };
  // squared distance to the nearest chosen point; -1: chosen
  thread_local std::vector<double> away;
  away.assign(points.size(), 1e300);
  auto pick = static_cast<std::size_t>(std::min_element(points.begin(), points.end(), deeper) -
                                       points.begin());
  for (std::size_t n = 0; n < most; ++n) {
    away[pick] = -1;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (away[i] >= 0)
        away[i] = std::min(away[i], (points[i].point - points[pick].point).squaredNorm());
    pick = static_cast<std::size_t>(std::max_element(away.begin(), away.end()) - away.begin());
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (away[i] < 0) points[kept++] = points[i];
  points.resize(kept);
}

}  // namespace tw
