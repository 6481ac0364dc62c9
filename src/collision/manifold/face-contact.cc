// The points where one polyhedron lies on a face of another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/face-contact.h"

#include <algorithm>

#include "base/constants.h"
#include "base/never.h"
#include "math/aabb.h"

namespace tw {

namespace {

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

// A face of the reference and one of the incident polyhedron.
struct FacePair {
  int reference, incident;

  bool operator==(const FacePair&) const = default;
};

// What of the one lies over the other.
struct FaceOverlap {
  const Polyhedron& reference;
  const Polyhedron& incident;
  const Frame& placed;  // the incident one in the frame of the reference
  FacePair pair;

  // Adds the corners of the overlap; the least gap of them.
  double add_corners(double slack, double near, std::vector<FacePoint>& corners,
                     std::vector<std::uint64_t>& left_out) const {
    thread_local std::vector<ClipCorner> polygon;
    thread_local std::vector<FacePoint> found;
    const Polyhedron::Face& face = reference.face(pair.reference);
    const Polyhedron::Face& incident_face = incident.face(pair.incident);
    polygon.clear();
    found.clear();
    for (int i = 0; i < incident_face.count; ++i) {
      const Vec3 point = placed * incident.vertex(incident.corner(incident_face.first + i));
      polygon.push_back({point, face.normal.dot(point) - face.offset, i});
    }
    for (int i = 0; i < face.count && !polygon.empty(); ++i)
      clip_by_side(polygon, reference.side(face.first + i), face.first + i, slack);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const int before = polygon[i > 0 ? i - 1 : polygon.size() - 1].next;
      add_point(found,
                {polygon[i].point, polygon[i].height,
                 corner_key(incident, incident_face, before, polygon[i].next), pair.reference,
                 pair.incident},
                near);
    }
    straighten(found, patch::missed_floor * (reference.radius() + incident.radius()), left_out);
    double least = 1e300;
    for (const FacePoint& corner : found) {
      least = std::min(least, corner.gap);
      add_point(corners, corner, near);
    }
    return least;
  }
};

// The faces beside those of the overlap that lie along the other one.
void add_neighbours(const FaceOverlap& overlap, std::vector<FacePair>& pairs) {
  const auto each_beside = [](const Polyhedron& p, int number, const Vec3& direction,
                              const auto& visit) {
    const Polyhedron::Face& face = p.face(number);
    for (int i = face.first; i < face.first + face.count; ++i) {
      const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(p.side(i).edge)];
      const int other = edge.left == number ? edge.right : edge.left;
      if (p.face(other).normal.dot(direction) >= patch::aligned) visit(other);
    }
  };
  const auto add = [&](const FacePair& fresh) {
    if (pairs.size() < patch::most_face_pairs &&
        std::find(pairs.begin(), pairs.end(), fresh) == pairs.end())
      pairs.push_back(fresh);
  };
  const FacePair here = overlap.pair;
  const Frame& placed = overlap.placed;
  const Vec3 up = overlap.reference.face(here.reference).normal;
  const Vec3 down = placed.R * overlap.incident.face(here.incident).normal;
  each_beside(overlap.incident, here.incident, -(placed.R.transpose() * up), [&](int face) {
    add({here.reference, face});
  });
  each_beside(overlap.reference, here.reference, -down, [&](int face) {
    add({face, here.incident});
  });
}

}  // namespace

double beside_face(const Polyhedron& p, const Polyhedron::Face& face, const Vec3& point) {
  double most = -never;
  for (int i = 0; i < face.count; ++i) {
    const Polyhedron::Side& side = p.side(face.first + i);
    most = std::max(most, side.offset - side.inward.dot(point));
  }
  return most;
}

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
                  std::size_t most, std::vector<FacePoint>& out, std::vector<FacePoint>& higher) {
  thread_local std::vector<std::uint64_t> left_out;
  thread_local std::vector<FacePair> pairs;
  thread_local std::vector<FacePoint> corners;
  const double size = reference.radius() + incident.radius();
  // corners this near a side lie on it: faces of equal outline would otherwise be cut at every
  // corner by rounding
  const double slack = 1e-12 * size;
  const double near = coincident_ratio * size;
  out.clear();
  higher.clear();
  left_out.clear();
  corners.clear();
  pairs.assign(1, {face_number, incident_number});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const FaceOverlap overlap{reference, incident, incident_in_reference, pairs[i]};
    if (overlap.add_corners(slack, near, corners, left_out) <= reach)
      add_neighbours(overlap, pairs);
  }
  // under the edge between two faces a point is as deep as under the higher one
  const auto is_under_another = [&](const FacePoint& p) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const FacePair& pair) {
      const Polyhedron::Face& face = reference.face(pair.reference);
      const double height = face.normal.dot(p.point) - face.offset;
      return height > p.gap + patch::missed_ratio * std::abs(p.gap) + near;
    });
  };
  if (pairs.size() > 1)
    corners.erase(std::remove_if(corners.begin(), corners.end(), is_under_another), corners.end());
  for (const FacePoint& corner : corners) (corner.gap <= reach ? out : higher).push_back(corner);

  // vertices that may come down, each on the face that it is highest over
  const Polyhedron::Face& first = reference.face(face_number);
  const Vec3 up = incident_in_reference.R.transpose() * first.normal;
  const double base = first.normal.dot(incident_in_reference.p) - first.offset;
  const int count = static_cast<int>(incident.vertices().size());
  for (int v = 0; v < count; ++v) {
    if (up.dot(incident.vertex(v)) + base > reach) continue;
    const Vec3 point = incident_in_reference * incident.vertex(v);
    FacePoint found{point, -1e300, vertex_key(v), face_number, incident_number};
    for (const FacePair& pair : pairs) {
      const Polyhedron::Face& face = reference.face(pair.reference);
      const double height = face.normal.dot(point) - face.offset;
      if (!(height > found.gap)) continue;
      found.gap = height;
      found.face = pair.reference;
    }
    if (!(found.gap <= reach)) continue;
    if (beside_face(reference, reference.face(found.face), point) > std::max(found.gap, slack))
      continue;
    const auto is_it = [&](const FacePoint& p) { return p.key == found.key; };
    if (std::find(left_out.begin(), left_out.end(), found.key) != left_out.end() ||
        std::any_of(out.begin(), out.end(), is_it))
      continue;
    add_point(out, found, near);
  }
  thin_face_points(out, most, reach);
}

void thin_face_points(std::vector<FacePoint>& points, std::size_t most, double reach) {
  if (points.size() <= most) return;
  std::sort(points.begin(), points.end(),
            [](const FacePoint& p, const FacePoint& q) { return p.key < q.key; });
  Aabb extent;
  double lowest = 1e300;
  for (const FacePoint& p : points) {
    extent.add(p.point);
    lowest = std::min(lowest, p.gap);
  }
  const double across = extent.size().norm(), about = patch::about_as_low * across;
  const double slope = reach / across + patch::least_slope;
  // how far a point may come below those chosen; -1e300: it is one
  thread_local std::vector<double> below, height;
  below.assign(points.size(), 1e299);
  height.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    height[i] = std::max(0.0, points[i].gap - lowest - about);
  auto pick =
      static_cast<std::size_t>(std::find(height.begin(), height.end(), 0.0) - height.begin());
  for (std::size_t n = 0; n < most; ++n) {
    below[pick] = -1e300;
    std::size_t next = pick;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (below[i] == -1e300) continue;
      const double distance = (points[i].point - points[pick].point).norm();
      below[i] = std::min(below[i], slope * distance + height[pick] - height[i]);
      // of equals the first one, whatever rounding says
      if (next == pick || below[i] > below[next] + 1e-9 * slope * across) next = i;
    }
    pick = next;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (below[i] == -1e300) points[kept++] = points[i];
  points.resize(kept);
}

}  // namespace tw
