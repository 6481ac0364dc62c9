// A cylinder on a plane: the points that carry it, lying, standing or on its rim.
//
// With m the plane's normal, a the axis and m' the part of m square to a, the lowest point of a rim
// about e is x = e - r m'/|m'|.  The ray from x along m meets the axis at a distance of rho =
// r/|m'|: a ball of that radius about that point of the axis touches the plane where the rim does,
// and goes on doing so while the cylinder spins about its axis: the core point of a rolling
// cylinder.
//
// Frames: world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "base/constants.h"
#include "collision/manifold-parts.h"
#include "geometry/polyhedron.h"

namespace tw {

struct PlacedCylinder {
  Vec3 center, axis, across;  // across: a direction fixed in the body, square to the axis
  double radius, half_length;

  PlacedCylinder(const ConvexPart& part, const Frame& frame);
  // The radius of the ball about a point of the axis that touches a plane with this normal, and the
  // lowest direction across the axis.  Upright: 0 and `across`.
  double rolling_radius(const Vec3& normal, Vec3& down) const;
};

// A plane with an outline; without sides it is unbounded.
struct Ground {
  Vec3 normal, point;  // unit, towards the cylinder
  std::vector<Polyhedron::Side> sides;
  std::uint64_t name = 0;
};

// Appends the points with gap <= reach, at most `patch::most_points`; `p` has what they share.
void cylinder_on_ground(const PlacedCylinder& cylinder, const Ground& ground, double reach,
                        ManifoldPoint p, std::vector<ManifoldPoint>& out);

}  // namespace tw
