// Where a rigid body is and how it moves, at one instant.
//
// Frames: of the body's principal frame at the centre of mass (what is given or fixed: of its body
// frame), in the world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// Velocity of the frame's origin, m/s, and angular velocity, rad/s; both world.
struct Twist {
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();

  bool operator==(const Twist&) const = default;
};

// Pose and twist: m, unit quaternion, m/s, rad/s.
struct PoseTwist {
  Vec3 x = Vec3::Zero();
  Quat q = Quat::Identity();
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();

  Frame frame() const { return Frame(q.toRotationMatrix(), x); }
  Vec3 velocity_at(const Vec3& where) const { return v + w.cross(where - x); }
};

}  // namespace tw
