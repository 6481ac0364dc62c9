// The point of a frustum that is nearest to a point.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// What turns about the axis of a frustum: of a part, or of a core.
struct FrustumProfile {
  double radius, top_radius, half_length, margin;

  template <class Frustum>
  FrustumProfile(const Frustum& f)
      : radius(f.radius), top_radius(f.top_radius), half_length(f.half_length), margin(f.margin) {}
};

// Whether it narrows: a cone to its tip.
inline bool narrows(const FrustumProfile& frustum) { return frustum.radius != frustum.top_radius; }

enum class FrustumFeature { side, cap, rim };

// In the frustum's frame, about z.
struct NearestOnFrustum {
  FrustumFeature feature = FrustumFeature::side;
  bool top = false;             // cap, rim: which end's
  Vec3 normal = Vec3::UnitX();  // unit, outward to the point
  Vec3 core = Vec3::Zero();     // the nearest of the core
  Vec3 point = Vec3::Zero();    // the nearest, `margin` farther along the normal
  double distance = 0;          // m, signed; inside: to the nearer of side and caps
};

// On the axis the side is met along x.
NearestOnFrustum nearest_on_frustum(const FrustumProfile& frustum, const Vec3& point);

// Unit normal of the side in the half-plane of one generatrix: (away from the axis, along it).
struct SideNormal {
  double across = 1, along = 0;

  explicit SideNormal(const FrustumProfile& frustum) {
    const double widening = frustum.top_radius - frustum.radius;
    if (widening == 0) return;
    const double height = 2 * frustum.half_length, length = std::hypot(height, widening);
    across = height / length;
    along = -widening / length;
  }
};

}  // namespace tw
