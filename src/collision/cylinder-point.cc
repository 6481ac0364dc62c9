// The point of a cylinder that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/cylinder-point.h"

#include <cmath>

namespace tw {

NearestOnCylinder nearest_on_cylinder(double radius, double half_length, const Vec3& point) {
  NearestOnCylinder result;
  const double across = std::hypot(point.x(), point.y());
  const Vec3 out = across > 0 ? Vec3(point.x() / across, point.y() / across, 0) : Vec3::UnitX();
  const Vec3 up(0, 0, point.z() < 0 ? -1 : 1);
  const double beside = across - radius;
  const double above = std::abs(point.z()) - half_length;
  if (beside > 0 && above > 0) {
    result.feature = CylinderFeature::rim;
    result.point = radius * out + half_length * up;
    result.distance = std::hypot(beside, above);
    result.normal = (beside * out + above * up) / result.distance;
    return result;
  }
  const bool cap = above > beside;
  result.feature = cap ? CylinderFeature::cap : CylinderFeature::side;
  result.normal = cap ? up : out;
  result.distance = cap ? above : beside;
  result.point = point - result.distance * result.normal;
  return result;
}

}  // namespace tw
