// Chatterjee and Ruina's impact law.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impact-law.h"

#include <Eigen/LU>

namespace tw {

Vec3 impact_impulse(const Mat3& K, const Vec3& n, const Vec3& u, double restitution,
                    double friction) {
  const double approach = u.dot(n);
  if (!(approach < 0)) return Vec3::Zero();

  // P_I, its normal part p1 > 0
  const double p1 = -approach / n.dot(K * n);
  const Vec3 bounce = (1 + restitution) * p1 * n;
  if (friction == 0) return bounce;

  // P_II - P_I, split along the normal and across
  const Vec3 p2 = -(K.inverse() * u);
  const Vec3 extra = p2 - p1 * n;
  const double extra_n = n.dot(extra);
  const double tangent = (p2 - n.dot(p2) * n).norm();

  // inside the cone: stick
  const Vec3 stick = bounce + extra;
  if (tangent <= friction * n.dot(stick)) return stick;

  // slide: on the cone; the denominator is positive because the sticking impulse lies outside
  const double kappa = friction * (1 + restitution) * p1 / (tangent - friction * extra_n);
  return bounce + kappa * extra;
}

}  // namespace tw
