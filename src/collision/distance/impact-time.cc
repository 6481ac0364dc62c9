// Exact impact times.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/impact-time.h"

#include <cmath>
#include <limits>

namespace tw {
namespace {
constexpr double never_touch = std::numeric_limits<double>::infinity();
}

double sphere_sphere_impact(const Vec3& r, const Vec3& u, double radius_sum) {
  // |r|^2 - R^2 + 2 (r.u) s + |u|^2 s^2 = 0
  const double b = r.dot(u);
  if (!(b < 0)) return never_touch;
  const double c = r.squaredNorm() - radius_sum * radius_sum;
  if (c <= 0) return 0;
  // b^2 - |u|^2 c, written so that it keeps its digits from any distance
  const double disc = u.squaredNorm() * (radius_sum * radius_sum) - r.cross(u).squaredNorm();
  if (!(disc > 0)) return never_touch;
  // the smaller root, without cancellation
  return c / (-b + std::sqrt(disc));
}

double sphere_plane_impact(double gap, double speed, double acceleration) {
  if (gap <= 0 && speed < 0) return 0;
  // touching, at rest or leaving no faster than it falls back at once: pressed on
  const double disc = speed * speed - 2 * acceleration * gap;
  if (acceleration < 0) {
    if (disc <= 0) return gap <= 0 ? 0 : never_touch;
    // the root at which it comes down: s = (speed + sqrt(disc)) / -acceleration
    const double root = std::sqrt(disc);
    return speed >= 0 ? (speed + root) / -acceleration : 2 * gap / (root - speed);
  }
  // not pulled down: it must already be moving down, and the pull away must not turn it first
  if (!(speed < 0) || !(disc > 0)) return never_touch;
  return 2 * gap / (std::sqrt(disc) - speed);
}

}  // namespace tw
