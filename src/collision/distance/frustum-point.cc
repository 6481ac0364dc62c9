// The point of a frustum that is nearest to a point.
//
// In the half-plane of the point and the axis the frustum is a polygon: bottom, side and top.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/frustum-point.h"

#include <algorithm>
#include <cmath>

namespace tw {

NearestOnFrustum nearest_on_frustum(const FrustumProfile& frustum, const Vec3& point) {
  const double half = frustum.half_length;
  const double across = std::hypot(point.x(), point.y());
  const Vec3 out = across > 0 ? Vec3(point.x() / across, point.y() / across, 0) : Vec3::UnitX();
  const SideNormal side(frustum);

  // over the side and the nearer end; how far along the side from its bottom to its top
  const double beside = side.across * (across - frustum.radius) + side.along * (point.z() + half);
  const double from_bottom =
      side.across * (point.z() + half) - side.along * (across - frustum.radius);
  const double from_top =
      side.across * (point.z() - half) - side.along * (across - frustum.top_radius);
  NearestOnFrustum result;
  result.top = !(point.z() < 0);
  const double above = std::abs(point.z()) - half;
  const double end_radius = result.top ? frustum.top_radius : frustum.radius;

  const auto set_rim = [&](bool top) {
    const double radius = top ? frustum.top_radius : frustum.radius;
    const double height = top ? half : -half;
    const double away = across - radius, up = point.z() - height;
    result.feature = FrustumFeature::rim;
    result.top = top;
    result.core = radius * out + height * Vec3::UnitZ();
    result.distance = std::hypot(away, up);
    result.normal = (away * out + up * Vec3::UnitZ()) / result.distance;
  };
  if (above > 0 && !(across > end_radius)) {
    result.feature = FrustumFeature::cap;
    result.distance = above;
    result.normal = Vec3(0, 0, result.top ? 1 : -1);
  } else if ((above > 0 || beside > 0) && from_bottom < 0) {
    set_rim(false);
  } else if ((above > 0 || beside > 0) && from_top > 0) {
    set_rim(true);
  } else if (beside > 0 || !(above > beside)) {
    result.feature = FrustumFeature::side;
    result.distance = beside;
    result.normal = side.across * out + side.along * Vec3::UnitZ();
  } else {
    result.feature = FrustumFeature::cap;
    result.distance = above;
    result.normal = Vec3(0, 0, result.top ? 1 : -1);
  }
  if (result.feature != FrustumFeature::rim) result.core = point - result.distance * result.normal;
  result.distance -= frustum.margin;
  result.point = result.core + frustum.margin * result.normal;
  return result;
}

}  // namespace tw
