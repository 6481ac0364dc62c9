// Keyframes: the given motion of a kinematic body, a pure function of time.
//
// Frames: the pose is that of the *body frame* in the world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "integrate/trajectory.h"

namespace tw {

struct Keyframe {
  double time = 0;
  Vec3 position = Vec3::Zero();
  std::optional<Quat> orientation;  // absent: that of the frame before
};

// Through the keyframes, at rest before the first and after the last.  Straight lines and constant
// angular velocity between them; with `smooth` the same path in minimum-jerk timing
// (10u^3 - 15u^4 + 6u^5), at rest at each keyframe.
// Errors: no keyframes, times that do not increase, values that are not finite.
TrajectoryPtr make_keyframes(std::vector<Keyframe> keyframes, bool smooth);

}  // namespace tw
