// Motion of kinematic bodies: a pure function of time.
//
// Frames: the pose is that of the *body frame* in the world.
// A motion bounds itself, so that certificates of collision checks and swept boxes are
// conservative.  Corners are times at which the velocity jumps.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "math/aabb.h"
#include "math/vec.h"

namespace tw {

class Motion {
 public:
  virtual ~Motion() = default;
  // Defined for every time; a pure function (same time, same bits).
  virtual Pose pose(double time) const = 0;
  // Velocity of the body frame's origin, m/s, and angular velocity, rad/s, both world.
  // At a corner: the right derivative.
  virtual void velocity(double time, Vec3& v, Vec3& w) const = 0;
  // Bounds over [from, to] on the origin's speed (m/s) and the angular speed (rad/s).
  virtual double speed_bound(double from, double to) const = 0;
  virtual double angular_speed_bound(double from, double to) const = 0;
  // A box around the origin's path over [from, to].
  virtual Aabb path_bounds(double from, double to) const = 0;
};

using MotionPtr = std::shared_ptr<const Motion>;

struct Keyframe {
  double time = 0;
  Vec3 position = Vec3::Zero();
  std::optional<Quat> orientation;  // absent: that of the frame before
};

// Through the keyframes, at rest before the first and after the last.  Straight lines and constant
// angular velocity between them; with `smooth` the same path in minimum-jerk timing
// (10u^3 - 15u^4 + 6u^5), at rest at each keyframe.
// Errors: no keyframes, times that do not increase, values that are not finite.
MotionPtr make_keyframes(std::vector<Keyframe> keyframes, bool smooth);

// A body that never moves.
MotionPtr make_fixed_motion(const Pose& pose);

}  // namespace tw
