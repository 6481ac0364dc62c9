// A polyhedron or a cylinder by its support points, as GJK and the expanding polytope see it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw {

// Placed in any frame that both cores of a pair share.
struct SupportCore {
  const Polyhedron* polyhedron = nullptr;  // or a cylinder:
  double radius = 0;
  double half_length = 0;
  Frame place;  // of the core's own frame

  SupportCore(const ConvexPart& part, const Frame& core_frame)
      : polyhedron(part.core.get()),
        radius(part.radius),
        half_length(part.half_length),
        place(core_frame) {}

  // The axis of a cylinder.
  Vec3 axis() const { return place.R.col(2); }
  Vec3 center() const { return polyhedron != nullptr ? place * polyhedron->center() : place.p; }
  double size() const {
    return polyhedron != nullptr ? polyhedron->radius() : std::hypot(radius, half_length);
  }
  // A point farthest along the direction, which need not be a unit vector.
  Vec3 support(const Vec3& direction) const {
    const Vec3 d = place.R.transpose() * direction;
    if (polyhedron != nullptr) return place * polyhedron->vertex(polyhedron->support(d, 0));
    const double across = std::hypot(d.x(), d.y());
    const double scale = across > 0 ? radius / across : 0;
    return place * Vec3(scale * d.x(), scale * d.y(), d.z() < 0 ? -half_length : half_length);
  }
};

// A point of the Minkowski difference A - B with the point of A that it came from.
struct DifferencePoint {
  Vec3 w = Vec3::Zero();
  Vec3 on_a = Vec3::Zero();
};

// The farthest along a direction, with B moved by `shift`.
inline DifferencePoint difference_support(const SupportCore& a, const SupportCore& b,
                                          const Vec3& shift, const Vec3& direction) {
  const Vec3 on_a = a.support(direction);
  return {on_a - (b.support(-direction) + shift), on_a};
}

}  // namespace tw
