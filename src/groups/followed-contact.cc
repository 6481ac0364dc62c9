// What a group follows of a point of a manifold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/followed-contact.h"

namespace tw {
namespace {

// S of the part in the body's frame; false, and 0, where it is no ellipsoid.
bool squares(const ConvexPart& part, Mat3& S) {
  if (part.kind != PartKind::ellipsoid) return false;
  const Mat3 axes = part.placement.R * part.semi_axes.asDiagonal();
  S = axes * axes.transpose();
  return true;
}

}  // namespace

GroupContact followed_contact(const ManifoldPoint& p, const Frame& reference,
                              const ConvexPart& reference_part, const Frame& other,
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
  if (p.kind == ReferenceFeature::tangent_plane || p.kind == ReferenceFeature::curved) {
    ContactEllipsoids ellipsoids;
    if (squares(other_part, ellipsoids.b)) {
      c.point_b = other_part.placement.p;
      c.radius_b = 0;
    }
    if (squares(reference_part, ellipsoids.a)) {
      c.point_a = reference_part.placement.p;
      c.radius_a = 0;
    }
    c.ellipsoids = std::make_shared<ContactEllipsoids>(ellipsoids);
  }
  return c;
}

}  // namespace tw
