// The point of an ellipsoid that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/ellipsoid-point.h"

#include <algorithm>
#include <cmath>

namespace tw {

NearestOnEllipsoid nearest_on_ellipsoid(const Vec3& semi_axes, const Vec3& query) {
  constexpr int most_steps = 100;
  int least = 0;
  const double shortest = semi_axes.minCoeff(&least);
  // in units of the shortest axis; t + s^2 = u + (s^2 - 1)
  const Vec3 s = semi_axes / shortest, y = query / shortest;
  const Vec3 excess = ((s.array() - 1) * (s.array() + 1)).matrix();
  const Vec3 sy = s.cwiseProduct(y.cwiseAbs());
  double u = (sy - excess).maxCoeff();
  double others = 0;  // without the shortest axis, at u = 0
  for (int i = 0; i < 3; ++i)
    if (sy[i] > 0) others += excess[i] > 0 ? (sy[i] / excess[i]) * (sy[i] / excess[i]) : 1;
  Vec3 x = Vec3::Zero();
  if (u > 0 || others > 1) {
    for (int step = 0; step < most_steps; ++step) {
      double value = -1, slope = 0;
      for (int i = 0; i < 3; ++i) {
        const double below = u + excess[i], ratio = below > 0 ? sy[i] / below : 0;
        value += ratio * ratio;
        if (below > 0) slope -= 2 * ratio * ratio / below;
      }
      if (!(value > 0) || !(slope < 0)) break;
      const double next = u - value / slope;
      if (!(next > u)) break;
      u = next;
    }
    for (int i = 0; i < 3; ++i) {
      const double below = u + excess[i];
      x[i] = below > 0 ? s[i] * s[i] * y[i] / below : 0;
    }
  } else {
    // on the plane across the shortest axis, so near to the middle that both ends are equally far
    for (int i = 0; i < 3; ++i) x[i] = excess[i] > 0 ? s[i] * s[i] * y[i] / excess[i] : 0;
    const double rest = 1 - x.cwiseQuotient(s).squaredNorm();
    x[least] = std::sqrt(std::max(rest, 0.0)) * (y[least] < 0 ? -1 : 1);
  }
  NearestOnEllipsoid result;
  result.normal = x.cwiseQuotient(s.cwiseAbs2()).normalized();
  // back onto the surface, along the ray from the middle
  x /= x.cwiseQuotient(s).norm();
  result.distance = shortest * result.normal.dot(y - x);
  result.point = query - result.distance * result.normal;
  return result;
}

}  // namespace tw
