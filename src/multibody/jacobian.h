// The geometric Jacobian of a link.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/kinematics.h"

namespace tw::multibody {

// J (6 x nv, column by column), world axes: rows 0 to 2 the velocity of the link's origin, m/s,
// rows 3 to 5 its angular velocity, rad/s, per unit of each u; what the base's own motion adds is
// not in it.  As placed.
void link_jacobian(const Tree& tree, const Kinematics& k, int link, Out J);

}  // namespace tw::multibody
