// What follows from the one dial that users see, `accuracy` (relative, default 1e-6).
//
// A contact is a spring: its depth, not the step tolerance, bounds how true a heap is.  Steps of
// contact groups therefore need not resolve more than a small share of the depth; measured motion
// hardly depends on the tolerance (doc/numerics/integration.md).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "dynamics/body.h"

namespace tw {

inline double accuracy_of_steps(double accuracy) {
  if (accuracy <= answer::true_steps) return accuracy;
  return std::clamp(0.1 * accuracy, answer::true_steps, answer::loosest_steps);
}

// Of one step of a contact group, m: `size` is the least width of its smallest member.  At the
// default accuracy a tenth of the static depth (2.5e-4 size).
inline double group_position_tolerance(double accuracy, double size) {
  return 25 * accuracy_of_steps(accuracy) * size;
}

// What moves slowly is followed more closely, as far as to the tolerances of an accuracy of 1e-6:
// by the fastest member's speed as a share of sqrt(g size), to a tenth.  Else a heap that comes to
// rest gains energy.
inline double group_closeness(double accuracy, double share_of_speed) {
  return std::min(1.0, std::max({share_of_speed, answer::closest_steps,
                                 answer::finest_accuracy / accuracy_of_steps(accuracy)}));
}

// m/s: what gravity does to a body of that size within the time of its contact.
inline double group_velocity_tolerance(double accuracy, double size, double gravity) {
  return 100 * accuracy_of_steps(accuracy) * std::sqrt(gravity * size);
}

// The edge of a cube as far across as the body, m: what it would be if it were not thin.
inline double cube_width(const Body& body) { return 2 / std::sqrt(3.0) * body.radius; }

}  // namespace tw
