// Where a ray meets a shape.
//
// Source: clipping by planes and quadrics, e.g. C. Ericson, Real-Time Collision Detection (2005),
// 5.3.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/shape.h"

namespace tw {

struct RayHit {
  double distance = 0;          // m, along the ray
  Vec3 normal = Vec3::UnitZ();  // unit, world, outward; against the ray where it begins inside
};

// The first point of from + s direction, 0 <= s <= most, in the shape; `direction` is a unit
// vector.  A ray that begins inside meets it at once.
std::optional<RayHit> cast_ray(const Shape& shape, const Frame& frame, const Vec3& from,
                               const Vec3& direction, double most);

}  // namespace tw
