// What a group follows of a point of a manifold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/followed-contact.h"

namespace tw {
namespace {

// What is followed as an ellipsoid within a radius; all in the body's frame.
struct Followed {
  Mat3 S;
  Vec3 center;
  double radius;
};

// The circle of a frustum, flat.
Followed circle(const Vec3& center, const Vec3& axis, double radius, double margin) {
  return {radius * radius * (Mat3::Identity() - axis * axis.transpose()), center, margin};
}

Followed ellipsoid(const ConvexPart& part) {
  const Mat3 axes = part.placement.R * part.semi_axes.asDiagonal();
  return {axes * axes.transpose(), part.placement.p, 0};
}

// The end of a frustum that a point of its surface is on.
Followed end_at(const ConvexPart& part, const Vec3& point) {
  const Vec3 axis = part.placement.R.col(2);
  const bool top = axis.dot(point - part.placement.p) > 0;
  const Vec3 center = part.placement.p + (top ? part.half_length : -part.half_length) * axis;
  return circle(center, axis, top ? part.top_radius : part.radius, part.margin);
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
    const auto follow = [](const Followed& f, Mat3& S, Vec3& point, double& radius) {
      S = f.S;
      point = f.center;
      radius = f.radius;
    };
    if (p.rim > 0)
      follow(circle(other.to_local(p.rim_center), c.other_direction, p.rim, other_part.margin),
             ellipsoids.b, c.point_b, c.radius_b);
    else if (other_part.kind == PartKind::ellipsoid)
      follow(ellipsoid(other_part), ellipsoids.b, c.point_b, c.radius_b);
    const Vec3 on_reference = p.core_point - (p.radius + p.gap) * p.normal;
    const bool shows_point = p.kind == ReferenceFeature::curved && p.direction.isZero(0);
    if (reference_part.kind == PartKind::ellipsoid)
      follow(ellipsoid(reference_part), ellipsoids.a, c.point_a, c.radius_a);
    else if (reference_part.kind == PartKind::frustum && shows_point)
      follow(end_at(reference_part, reference.to_local(on_reference)), ellipsoids.a, c.point_a,
             c.radius_a);
    c.ellipsoids = std::make_shared<ContactEllipsoids>(ellipsoids);
  }
  return c;
}

}  // namespace tw
