// What edits and callbacks may do to the joints of a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/multibody.h"

namespace tw {

// `after` is what became of `before` at a time; its quaternions are made unit ones, and a
// coordinate that was changed no longer leans on its stop.
//
// Errors, with the joint's name: numbers that are not finite, quaternions that are zero, positions
// that were changed where that may not be (`may_place`) or are beyond limits, links faster than
// limits.h allows, inputs that require_inputs refuses, torques by which a joint would be faster
// than greatest_angular_acceleration.
void check_joints(const Multibody& multibody, const MultibodyState& before, double time,
                  bool may_place, MultibodyState& after);

}  // namespace tw
