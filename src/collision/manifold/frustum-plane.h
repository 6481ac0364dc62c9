// A frustum on a plane: the points that carry it, lying, standing, on a rim or on its tip.
//
// With m the plane's normal, a the axis and m' the part of m square to a, the lowest point of a rim
// about e is x = e - r m'/|m'|.  The ray from x along m meets the axis at a distance of rho =
// r/|m'|: a ball of that radius about that point of the axis touches the plane where the rim does,
// and goes on doing so while the frustum spins about its axis: the core point of what rolls, a tip
// (r = 0) as well.  What is within a margin adds that to the ball.  Only the circle itself does so
// while the frustum tilts: it is followed as a flat ellipsoid (`tangent_plane`) unless it is level.
//
// Frames: world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "base/constants.h"
#include "collision/manifold/manifold-parts.h"
#include "geometry/polyhedron.h"

namespace tw {

// How a frustum stands to a plane.
struct Tilt {
  Vec3 down;        // the lowest direction across the axis
  double sine = 0;  // |m'|; upright: 0, and `down` is fixed in the body

  bool upright() const { return sine == 0; }
};

struct PlacedFrustum {
  Vec3 center, axis, across;  // across: a direction fixed in the body, square to the axis
  double bottom_radius, top_radius, half_length, margin;

  PlacedFrustum(const ConvexPart& part, const Frame& frame);
  double end_radius(bool top) const { return top ? top_radius : bottom_radius; }
  Vec3 end(bool top) const { return center + (top ? half_length : -half_length) * axis; }
  double widest() const { return std::max(bottom_radius, top_radius) + margin; }
  // That of the core at a point.
  double radius_at(const Vec3& point) const;
  Tilt tilt(const Vec3& normal) const;
  // The radius of the ball about a point of the axis that touches a plane where the core has this
  // radius; upright that of a corner.
  double rolling_radius(double radius, const Tilt& tilt) const {
    return (tilt.upright() ? 0 : radius / tilt.sine) + margin;
  }
};

// A plane with an outline; without sides it is unbounded.
struct Ground {
  Vec3 normal, point;  // unit, towards the frustum
  std::vector<Polyhedron::Side> sides;
  std::uint64_t name = 0;
  double parallel = 1;  // to the axis of least distance; 0: taken for it no longer
};

// Appends the points with gap <= reach, at most `patch::most_points`; `p` has what they share.
void frustum_on_ground(const PlacedFrustum& frustum, const Ground& ground, double reach,
                       const ManifoldPoint& p, std::vector<ManifoldPoint>& out);

}  // namespace tw
