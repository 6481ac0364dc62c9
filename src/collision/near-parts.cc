// Parts that come near, by the tree of their shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/near-parts.h"

#include "geometry/polyhedron.h"

namespace tw {

bool far_apart(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
               double reach) {
  if (a.kind == PartKind::half_space || b.kind == PartKind::half_space) return false;
  const double near = (a.bound_radius + b.bound_radius) * (1 + 1e-12) + reach;
  return (frame_b * b.bound_center - frame_a * a.bound_center).squaredNorm() > near * near;
}

bool beyond_a_face(const ConvexPart& ball, const Frame& frame_b, const ConvexPart& polyhedron,
                   const Frame& frame_p, double reach) {
  if (polyhedron.kind != PartKind::polyhedron || ball.kind == PartKind::half_space) return false;
  int face = 0;
  const Vec3 center = (frame_p * polyhedron.placement).to_local(frame_b * ball.bound_center);
  const double height = polyhedron.core->face_separation(center, face);
  return height - ball.bound_radius > reach + 1e-12 * (height + polyhedron.bound_radius);
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

void parts_near(const Shape& shape, const ConvexPart& other, const Frame& frame, double reach,
                std::vector<std::uint32_t>& out) {
  Aabb box = part_bounds(other, frame);
  // rounding of the frame and of the boxes
  const double size = frame.p.cwiseAbs().maxCoeff() + shape.radius_about_origin();
  box.grow(reach + 1e-14 * size);
  parts_in(shape, box, out);
}

}  // namespace tw
