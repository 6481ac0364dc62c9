// Parts that come near, by the tree of their shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/near-parts.h"

namespace tw {

bool far_apart(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
               double reach) {
  if (a.kind == PartKind::half_space || b.kind == PartKind::half_space) return false;
  const double near = (a.bound_radius + b.bound_radius) * (1 + 1e-12) + reach;
  return (frame_b * b.bound_center - frame_a * a.bound_center).squaredNorm() > near * near;
}

Aabb seen_from(const Frame& frame, const Aabb& box) {
  const Vec3 middle = frame.to_local(box.center());
  const Vec3 reach = 0.5 * (frame.R.transpose().cwiseAbs() * box.size());
  return {middle - reach, middle + reach};
}

void parts_in(const Shape& shape, const Aabb& box, std::vector<std::uint32_t>& out) {
  out.clear();
  shape.tree()->overlapping(box, [&](std::uint32_t i) {
    if (part_bounds(shape.part(i), Frame()).overlaps(box)) out.push_back(i);
  });
  std::sort(out.begin(), out.end());
}

void parts_near(const Shape& shape, const ConvexPart& other, const Frame& frame, double reach,
                std::vector<std::uint32_t>& out) {
  out.clear();
  Aabb box = part_bounds(other, frame);
  // rounding of the frame and of the boxes
  const double size = frame.p.cwiseAbs().maxCoeff() + shape.radius_about_origin();
  box.grow(reach + 1e-14 * size);
  shape.tree()->overlapping(box, [&](std::uint32_t number) { out.push_back(number); });
  std::sort(out.begin(), out.end());
}

}  // namespace tw
