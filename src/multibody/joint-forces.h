// What passes through the joints of a multibody, welds included.
//
// Link i is carried by the force f_i through its joint, from what it hangs on; with what acts on it
// from outside and on to what hangs on it, Newton and Euler say
//   f_i = rate of momentum_i - wrench_i + sum of f_j over the links j that hang on i.
// By links, where the dynamics go by nodes: links that are welded to one another share a node, and
// the force through a weld is one that a node knows nothing of.
//
// Frames: forces about k.origin, world axes.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), section 5.3.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "multibody/kinematics.h"

namespace tw::multibody {

// By link: on it, through its joint.  `accelerations`: by node, of u' alone, as Articulation and
// InverseDynamics have them; `wrenches`: by link, from outside, gravity not included.  Wrenches
// within `k` do not count.
std::vector<Force> joint_forces(const Tree& tree, const Kinematics& k,
                                std::span<const Motion> accelerations,
                                std::span<const Force> wrenches);

}  // namespace tw::multibody
