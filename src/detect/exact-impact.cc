// Exact impacts of spheres and planes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/exact-impact.h"

#include <cmath>

#include "base/constants.h"
#include "collision/distance/impact-time.h"
#include "detect/approach.h"

namespace tw {
namespace {

// Seconds from `start` to the first impact of a ball on a fixed plane.
double ball_meets_plane(const Body& ball, const Parabola& path, const Body& plane, double start) {
  const Vec3& n = plane.plane_normal;
  const Vec3 v = path.velocity(start);
  double speed = n.dot(v);
  if (std::abs(speed) <= answer::speed_noise * v.norm()) speed = 0;
  const double gap = n.dot(path.position(start)) - plane.plane_offset - ball.sphere_radius;
  return sphere_plane_impact(gap, speed, n.dot(path.acceleration));
}

}  // namespace

bool predicted_exactly(const Piece& piece) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  const Parabola* path_a = piece.a->ballistic();
  const Parabola* path_b = piece.b->ballistic();
  if (!path_a || !path_b) return false;
  if (a.sphere_radius >= 0 && b.sphere_radius >= 0)
    return path_a->acceleration == path_b->acceleration;
  return (a.sphere_radius >= 0 && b.is_fixed_plane) || (b.sphere_radius >= 0 && a.is_fixed_plane);
}

double exact_impact(const Piece& piece) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  const double start = piece.start_time();
  const Parabola& path_a = *piece.a->ballistic();
  const Parabola& path_b = *piece.b->ballistic();
  if (a.is_fixed_plane) return start + ball_meets_plane(b, path_b, a, start);
  if (b.is_fixed_plane) return start + ball_meets_plane(a, path_a, b, start);

  const Vec3 va = path_a.velocity(start), vb = path_b.velocity(start);
  const Vec3 r = path_b.position(start) - path_a.position(start), u = vb - va;
  if (r.dot(u) >= 0) return never;
  // what an impact left behind is no approach
  const double noise = answer::speed_noise * (va.norm() + vb.norm());
  if (r.dot(u) > -noise * r.norm()) return never;
  return start + sphere_sphere_impact(r, u, a.sphere_radius + b.sphere_radius);
}

}  // namespace tw
