// What a group follows of a point of a manifold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/followed-contact.h"

namespace tw {
namespace {

// What is followed as an ellipsoid, or a circle of a frustum within its margin; in the body's
// frame.
struct Followed {
  Mat3 axes;
  Vec3 center;
  double radius;
};

Followed circle(const Vec3& center, const Vec3& axis, double radius, double margin) {
  const Vec3 across = axis.unitOrthogonal();
  Mat3 axes;
  axes << radius * across, radius * axis.cross(across), Vec3::Zero();
  return {axes, center, margin};
}

Followed ellipsoid(const ConvexPart& part) {
  return {part.placement().R * part.semi_axes.asDiagonal(), part.placement().p, 0};
}

}  // namespace

GroupContact followed_contact(const ManifoldPoint& p, const Frame& reference,
                              const ConvexPart& reference_part, const Frame& other,
                              const ConvexPart& other_part) {
  GroupContact c;
  c.feature = p.kind;
  c.normal = reference.R.transpose() * p.normal;
  c.direction = reference.R.transpose() * p.direction;
  c.other_direction = other.R.transpose() * p.other_direction;
  c.point_a = reference.to_local(p.reference_point);
  c.point_b = other.to_local(p.core_point);
  c.radius_a = p.reference_radius;
  c.radius_b = p.radius;
  if (p.kind == ContactFeature::rim) {
    c.rim = p.rim;
    c.point_b = other.to_local(p.rim_center);
  }
  if (p.kind == ContactFeature::tangent_plane || p.kind == ContactFeature::curved) {
    ContactEllipsoids ellipsoids;
    const auto follow = [](const Followed& f, Mat3& axes, Vec3& point, double& radius) {
      axes = f.axes;
      point = f.center;
      radius = f.radius;
    };
    if (p.rim > 0)
      follow(circle(other.to_local(p.rim_center), c.other_direction, p.rim, other_part.margin),
             ellipsoids.b, c.point_b, c.radius_b);
    else if (other_part.kind == PartKind::ellipsoid)
      follow(ellipsoid(other_part), ellipsoids.b, c.point_b, c.radius_b);
    if (reference_part.kind == PartKind::ellipsoid)
      follow(ellipsoid(reference_part), ellipsoids.a, c.point_a, c.radius_a);
    c.ellipsoids = std::make_shared<ContactEllipsoids>(ellipsoids);
  }
  return c;
}

}  // namespace tw
