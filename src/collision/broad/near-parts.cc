// Parts that come near, by the tree of their shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/broad/near-parts.h"

#include <cmath>
#include <numeric>

#include "geometry/polyhedron.h"

namespace tw {

bool far_apart(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
               double reach) {
  if (a.kind == PartKind::half_space || b.kind == PartKind::half_space) return false;
  const double near = (a.bound_radius + b.bound_radius) * (1 + 1e-12) + reach;
  return (frame_b * b.bound_center - frame_a * a.bound_center).squaredNorm() > near * near;
}

FaceGap gap_over_face(const ConvexPart& part, const Frame& frame, const ConvexPart& other,
                      const Frame& other_frame) {
  if (other.kind != PartKind::polyhedron || part.kind == PartKind::half_space) return {};
  const Frame world = other.in(other_frame);
  const Vec3 center = frame * part.bound_center;
  int face = 0;
  const double height = other.core->face_separation(world.to_local(center), face);
  const Vec3 normal = world.R * other.core->face(face).normal;
  double reach = part.bound_radius;
  if (part.kind == PartKind::polyhedron) {
    const Vec3 down = -normal;
    const Mat3 R = frame.R * part.placement().R;
    reach = part.core->extent(R.transpose() * down, 0) - down.dot(R * part.core->center());
  }
  // less what rounding can do to it
  const double rounding = 1e-13 * (std::abs(height) + part.bound_radius + other.bound_radius);
  return {height - reach - rounding, normal, center - height * normal};
}

Aabb seen_from(const Frame& frame, const Aabb& box) {
  const Vec3 middle = frame.to_local(box.center());
  const Vec3 reach = 0.5 * (frame.R.transpose().cwiseAbs() * box.size());
  return {middle - reach, middle + reach};
}

void parts_in(const Shape& shape, const Aabb& box, std::vector<std::uint32_t>& out) {
  out.clear();
  shape.tree()->overlapping(box, [&](std::uint32_t number) { out.push_back(number); });
  std::sort(out.begin(), out.end());
}

void parts_around(const Shape& shape, const Frame& frame, const Aabb& place,
                  std::vector<std::uint32_t>& out) {
  if (shape.tree()) return parts_in(shape, seen_from(frame, place), out);
  out.resize(shape.part_count());
  std::iota(out.begin(), out.end(), 0);
}

void parts_near(const Shape& shape, const ConvexPart& other, const Frame& frame, double reach,
                std::vector<std::uint32_t>& out) {
  Aabb box = part_bounds(other, frame);
  // rounding of the frame and of the boxes
  const double size = frame.p.cwiseAbs().maxCoeff() + shape.radius_about_origin();
  box.grow(reach + 1e-14 * size);
  parts_in(shape, box, out);
}

}  // namespace tw
