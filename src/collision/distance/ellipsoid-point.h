// The point of an ellipsoid that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// In the ellipsoid's frame.
struct NearestOnEllipsoid {
  Vec3 normal = Vec3::UnitX();  // unit, outward
  Vec3 point = Vec3::Zero();    // the nearest of the surface
  double distance = 0;          // m, signed; point = query - distance * normal
};

// x = s^2 y/(t + s^2) axis by axis, for the greatest t for which that is on the surface: Newton's
// method on the convex function sum (s y/(t + s^2))^2 - 1, from below.  To rounding.
NearestOnEllipsoid nearest_on_ellipsoid(const Vec3& semi_axes, const Vec3& query);

}  // namespace tw
