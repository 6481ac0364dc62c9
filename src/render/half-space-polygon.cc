// Cutting half-space faces by each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/half-space-polygon.h"

#include <cmath>

namespace tw {

namespace {

// The face as a polygon that still has to be cut; solid where normal.x <= offset.
struct Face {
  HalfSpacePolygon polygon;
  double offset = 0;
  bool visible = true;
};

Face make_face(std::size_t body, const Frame& frame, const ConvexPart& part, bool visible) {
  Face face;
  face.visible = visible;
  HalfSpacePolygon& p = face.polygon;
  p.body = body;
  p.normal = frame.R * part.normal;
  face.offset = part.offset + p.normal.dot(frame.p);
  p.origin = frame * Vec3(part.offset * part.normal);
  // axes that turn with the body: across the normal and the body's axis farthest from it
  int axis = 0;
  part.normal.cwiseAbs().minCoeff(&axis);
  p.u = frame.R * Vec3::Unit(axis).cross(part.normal).normalized();
  p.v = p.normal.cross(p.u);
  return face;
}

std::vector<Face> all_faces(std::span<const DrawBody> bodies, std::span<const Pose> poses) {
  std::vector<Face> faces;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].shape || bodies[i].visual || bodies[i].shape->bounded()) continue;
    if (!is_finite(poses[i].p) || !is_finite(poses[i].q)) continue;
    for (const ConvexPart& part : bodies[i].shape->parts())
      if (part.kind == PartKind::half_space)
        faces.push_back(make_face(i, Frame(poses[i]), part, bodies[i].visible));
  }
  return faces;
}

std::vector<Vec3> square(const HalfSpacePolygon& face, double offset, const Vec3& center,
                         double reach) {
  const Vec3 middle = center - (face.normal.dot(center) - offset) * face.normal;
  const Vec3 u = reach * face.u, v = reach * face.v;
  return {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
}

// Keeps what lies outside the solid normal.x <= offset; what touches it stays.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec3& normal, double offset,
                      double tolerance) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double height_a = normal.dot(a) - offset, height_b = normal.dot(b) - offset;
    if (height_a >= -tolerance) kept.push_back(a);
    if ((height_a < -tolerance) != (height_b < -tolerance))
      kept.push_back(a + (height_a / (height_a - height_b)) * (b - a));
  }
  return kept;
}

void cut_by_others(std::vector<Face>& faces, const Vec3& center, double reach) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    HalfSpacePolygon& face = faces[i].polygon;
    face.corners = square(face, faces[i].offset, center, reach);
    for (std::size_t j = 0; j < faces.size(); ++j)
      if (j != i)
        face.corners = cut(face.corners, faces[j].polygon.normal, faces[j].offset, 1e-9 * reach);
  }
}

}  // namespace

std::vector<HalfSpacePolygon> half_space_polygons(std::span<const DrawBody> bodies,
                                                  std::span<const Pose> poses, const Vec3& center,
                                                  double reach) {
  std::vector<Face> faces = all_faces(bodies, poses);
  cut_by_others(faces, center, reach);
  std::vector<HalfSpacePolygon> polygons;
  for (Face& face : faces)
    if (face.visible && face.polygon.corners.size() >= 3)
      polygons.push_back(std::move(face.polygon));
  return polygons;
}

void add_enclosed_room(std::span<const DrawBody> bodies, std::span<const Pose> poses,
                       Aabb& bounds) {
  std::vector<Face> faces = all_faces(bodies, poses);
  const Vec3 center = bounds.empty() ? Vec3(Vec3::Zero()) : bounds.center();
  // far larger than any room: what lies beyond half of it is a corner of the square, not of a room
  const double reach = 1e6 * (1 + (bounds.empty() ? 0.0 : bounds.size().norm()));
  cut_by_others(faces, center, reach);
  for (const Face& face : faces)
    for (const Vec3& corner : face.polygon.corners)
      if ((corner - center).cwiseAbs().maxCoeff() < 0.01 * reach) bounds.add(corner);
}

}  // namespace tw
