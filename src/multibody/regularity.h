// Whether a multibody's masses determine all its accelerations.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/kinematics.h"

namespace tw::multibody {

// What a joint moves, were all beyond it stiff: mass, kg, and polar second moment about the joint's
// origin, kg m^2, as placed.
struct Beyond {
  double mass = 0, second = 0;
};
Beyond beyond(const Tree& tree, const Kinematics& k, int node);

// The first dof, seen from the leaves, whose acceleration no mass determines in any configuration;
// -1: none.  Configurations are drawn, always the same: a few, for what is singular in one only is
// no fault of the tree.
int undetermined_dof(const Tree& tree);

}  // namespace tw::multibody
