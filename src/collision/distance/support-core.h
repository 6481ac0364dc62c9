// A convex core by its support points, as GJK and the expanding polytope see it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw {

// Placed in any frame that both cores of a pair share.  What is within `margin` of a frustum is not
// of the core.
struct SupportCore {
  PartKind kind;
  const Polyhedron* polyhedron = nullptr;
  double radius = 0, top_radius = 0, half_length = 0, margin = 0;  // frustum
  Vec3 semi_axes = Vec3::Zero();                                   // ellipsoid
  Frame place;                                                     // of the core's own frame

  SupportCore(const ConvexPart& part, const Frame& core_frame)
      : kind(part.kind),
        polyhedron(part.core.get()),
        radius(part.radius),
        top_radius(part.top_radius),
        half_length(part.half_length),
        margin(part.margin),
        semi_axes(part.semi_axes),
        place(core_frame) {}

  // The axis of a frustum.
  Vec3 axis() const { return place.R.col(2); }
  Vec3 center() const { return polyhedron != nullptr ? place * polyhedron->center() : place.p; }
  double size() const {
    if (polyhedron != nullptr) return polyhedron->radius();
    if (kind == PartKind::ellipsoid) return semi_axes.maxCoeff();
    return std::hypot(std::max(radius, top_radius), half_length);
  }
  // How thick it is, to either side of its middle; of a polyhedron as wide as it is, of a segment
  // its length.
  double half_width() const {
    if (kind == PartKind::ellipsoid) return semi_axes.minCoeff();
    const double widest = std::max(radius, top_radius);
    return polyhedron == nullptr && widest > 0 ? std::min(widest, half_length) : size();
  }
  // As much smaller about its centre.
  void scale(double factor) {
    radius *= factor;
    top_radius *= factor;
    half_length *= factor;
    margin *= factor;
    semi_axes *= factor;
  }
  // A point farthest along the direction, which need not be a unit vector.
  Vec3 support(const Vec3& direction) const {
    const Vec3 d = place.R.transpose() * direction;
    if (polyhedron != nullptr) return place * polyhedron->vertex(polyhedron->support(d, 0));
    if (kind == PartKind::ellipsoid) {
      const Vec3 scaled = semi_axes.cwiseProduct(d);
      const double length = scaled.norm();
      return length > 0 ? place * Vec3(semi_axes.cwiseProduct(scaled) / length) : place.p;
    }
    const double across = std::hypot(d.x(), d.y());
    const bool down = 2 * half_length * d.z() < (radius - top_radius) * across;
    const double scale = across > 0 ? (down ? radius : top_radius) / across : 0;
    return place * Vec3(scale * d.x(), scale * d.y(), down ? -half_length : half_length);
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
