// What a group follows of a point of a manifold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/followed-contact.h"

namespace tw {

GroupContact followed_contact(const ManifoldPoint& p, const Frame& reference, const Frame& other,
                              const ConvexPart& other_part) {
  GroupContact c;
  c.feature = static_cast<ContactFeature>(p.kind);
  c.normal = reference.R.transpose() * p.normal;
  c.direction = reference.R.transpose() * p.direction;
  c.other_direction = other.R.transpose() * p.other_direction;
  c.point_a = reference.to_local(p.reference_point);
  c.point_b = other.to_local(p.core_point);
  c.radius_a = p.reference_radius;
  c.radius_b = p.radius;
  if (p.kind == ReferenceFeature::rim) {
    c.rim = p.rim;
    c.point_b = other.to_local(p.rim_center);
  }
  if (p.kind == ReferenceFeature::tangent_plane) {
    // the squares of the semi-axes along the axes of the part
    const Mat3 axes = other_part.placement.R * other_part.semi_axes.asDiagonal();
    const Mat3 squares = axes * axes.transpose();
    c.direction = squares.diagonal();
    c.other_direction = {squares(1, 2), squares(0, 2), squares(0, 1)};
    c.point_b = other_part.placement.p;
    c.radius_b = 0;
  }
  return c;
}

}  // namespace tw
