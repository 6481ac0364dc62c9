// Exact impact times: quadratics for pairs that fall alike.
//
// Symbols: r relative position of b from a, u relative velocity, both at the common start; R the
// sum of the radii.  Times are counted from the common start; `never` (infinity) if there is no
// impact. Overlapping and approaching at the start is an impact at 0; overlapping and separating is
// none.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// Two spheres in the same acceleration: the least s >= 0 with |r + u s| = R, approaching.
double sphere_sphere_impact(const Vec3& r, const Vec3& u, double radius_sum);

// A sphere above a plane that does not move: the least s >= 0 with
// gap + speed s + acceleration s^2 / 2 = 0 going down.  gap, speed and acceleration along the
// outward normal; gap is that of the surface (m).
double sphere_plane_impact(double gap, double speed, double acceleration);

}  // namespace tw
