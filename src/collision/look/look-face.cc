// The points at which one polyhedron lies on a face of another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/look/look-face.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/never.h"

namespace tw {

namespace {

constexpr std::size_t most_of_a_face = patch::most_points / 2;

// A corner that came from no vertex, by the two lines that meet in it.
std::uint64_t crossing_key(int before, int after) {
  return edge_crossing << 60 | static_cast<std::uint64_t>(before & 0xffffff) << 24 |
         static_cast<std::uint64_t>(after & 0xffffff);
}

// The lines of the incident face are its sides, those of the reference ~ its sides; two of the
// former that follow on each other meet in a vertex.
std::uint64_t corner_key(const Polyhedron& incident, int before, int after) {
  if (before < 0 || after < 0) return crossing_key(before, after);
  return static_cast<std::uint64_t>(incident.corner(after));
}

}  // namespace

int face_along(const Polyhedron& p, const Vec3& direction, int start) {
  int best = start;
  double most = p.face(start).normal.dot(direction);
  for (;;) {
    const Polyhedron::Face& face = p.face(best);
    int next = -1;
    for (int i = face.first; i < face.first + face.count; ++i) {
      const Polyhedron::Edge& edge = p.edges()[static_cast<std::size_t>(p.side(i).edge)];
      const int other = edge.left == best ? edge.right : edge.left;
      const double along = p.face(other).normal.dot(direction);
      if (along > most) most = along, next = other;
    }
    if (next < 0) return best;
    best = next;
  }
}

void look_at_face(const Polyhedron& reference, int face_number, const Polyhedron& incident,
                  const Frame& placed, int incident_face, double reach, FaceLook& out) {
  thread_local std::vector<ClipCorner> polygon;
  const Polyhedron::Face& face = reference.face(face_number);
  const Polyhedron::Face& other = incident.face(incident_face);
  const double size = reference.radius() + incident.radius(), slack = 1e-12 * size;
  polygon.clear();
  for (int i = other.first; i < other.first + other.count; ++i) {
    const Vec3 point = placed * incident.vertex(incident.corner(i));
    polygon.push_back({point, face.normal.dot(point) - face.offset, i});
  }
  for (int i = 0; i < face.count && !polygon.empty(); ++i)
    clip_by_side(polygon, reference.side(face.first + i), face.first + i, slack);

  out.points.clear();
  out.of_vertices = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClipCorner& corner = polygon[i];
    if (!(corner.height <= reach)) continue;
    const int before = polygon[i > 0 ? i - 1 : polygon.size() - 1].next;
    const std::uint64_t key = corner_key(incident, before, corner.next);
    out.of_vertices = out.of_vertices && key >> 60 == vertex_point;
    out.points.push_back({corner.point, corner.height, key, face_number, incident_face});
  }
  // vertices that may come down: one that stands higher than it is beside the face
  const Vec3 up = placed.R.transpose() * face.normal;
  const double base = face.normal.dot(placed.p) - face.offset;
  const std::vector<Vec3>& vertices = incident.vertices();
  const std::size_t of_polygon = out.points.size();
  out.room = never;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const double height = up.dot(vertices[v]) + base;
    if (!(height <= reach)) continue;
    const Vec3 point = placed * vertices[v];
    const double beside = beside_face(reference, face, point);
    out.room = std::min(out.room, std::abs(beside));
    if (beside > std::max(height, slack)) continue;
    const auto is_it = [&](const FacePoint& p) { return p.key == v; };
    const auto end = out.points.begin() + static_cast<std::ptrdiff_t>(of_polygon);
    if (std::find_if(out.points.begin(), end, is_it) != end) continue;
    out.points.push_back({point, height, v, face_number, incident_face});
  }
  thin_face_points(out.points, most_of_a_face, reach);
  out.lowest = never;
  for (const FacePoint& p : out.points) out.lowest = std::min(out.lowest, p.gap);
}

}  // namespace tw
