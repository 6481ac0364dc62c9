// The point of a cylinder that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

enum class CylinderFeature { side, cap, rim };

// In the cylinder's frame, about z.
struct NearestOnCylinder {
  CylinderFeature feature = CylinderFeature::side;
  Vec3 normal = Vec3::UnitX();  // unit, outward to the point
  Vec3 point = Vec3::Zero();    // the nearest
  double distance = 0;          // m, signed; inside: to the nearer of side and cap
};

// On the axis the side is met along x.
NearestOnCylinder nearest_on_cylinder(double radius, double half_length, const Vec3& point);

}  // namespace tw
