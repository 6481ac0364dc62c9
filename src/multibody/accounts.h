// Energy, momentum and centre of mass of a multibody, as placed; links welded to the base left out.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/kinematics.h"

namespace tw::multibody {

double kinetic_energy(const Tree& tree, const Kinematics& k);  // J
// J, 0 at the world's origin.  That of springs: spring_energy.
double gravity_energy(const Tree& tree, const Kinematics& k, const Vec3& gravity);
Vec3 momentum(const Tree& tree, const Kinematics& k);                             // N s
Vec3 angular_momentum(const Tree& tree, const Kinematics& k, const Vec3& point);  // N m s, about it
// m, in the world; not a number where nothing has mass.
Vec3 center_of_mass(const Tree& tree, const Kinematics& k);

}  // namespace tw::multibody
