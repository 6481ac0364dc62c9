// Exact impacts of spheres and planes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/exact-impact.h"

#include <cmath>

#include "collision/impact-time.h"
#include "detect/approach.h"
#include "timeline/arc.h"

namespace tw {
namespace {

Vec3 center_velocity(const Body& body, const State& arc, double when) {
  if (!body.dynamic()) return Vec3::Zero();
  return arc.v + (when - arc.arc_time) * arc.acceleration;
}

// Seconds from `start` to the first impact of a ball on a fixed plane.
double ball_meets_plane(const Body& ball, const State& arc, const Body& plane, double start) {
  const Vec3& n = plane.plane_normal;
  const Vec3 v = center_velocity(ball, arc, start);
  double speed = n.dot(v);
  if (std::abs(speed) <= speed_noise * v.norm()) speed = 0;
  const double gap = n.dot(center_at(ball, arc, start)) - plane.plane_offset - ball.sphere_radius;
  return sphere_plane_impact(gap, speed, n.dot(arc.acceleration));
}

}  // namespace

bool predicted_exactly(const Piece& piece) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  if (piece.a->group || piece.b->group) return false;
  if (a.sphere_radius >= 0 && b.sphere_radius >= 0) {
    if (a.kinematic() || b.kinematic()) return false;
    return piece.a->acceleration == piece.b->acceleration;
  }
  return (a.sphere_radius >= 0 && b.is_fixed_plane) || (b.sphere_radius >= 0 && a.is_fixed_plane);
}

double exact_impact(const Piece& piece) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  const double start = piece.start_time();
  if (a.is_fixed_plane) return start + ball_meets_plane(b, *piece.b, a, start);
  if (b.is_fixed_plane) return start + ball_meets_plane(a, *piece.a, b, start);

  const Vec3 va = center_velocity(a, *piece.a, start), vb = center_velocity(b, *piece.b, start);
  const Vec3 r = center_at(b, *piece.b, start) - center_at(a, *piece.a, start), u = vb - va;
  if (r.dot(u) >= 0) return never;
  // what an impact left behind is no approach
  const double noise = speed_noise * (va.norm() + vb.norm());
  if (r.dot(u) > -noise * r.norm()) return never;
  return start + sphere_sphere_impact(r, u, a.sphere_radius + b.sphere_radius);
}

}  // namespace tw
