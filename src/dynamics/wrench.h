// Force and torque on a rigid body, and how they depend on what bodies do.
//
// Frames: all vectors in the world frame; torques about the centre of mass; rotations and their
// changes as short rotation vectors.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

struct Wrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m
};

// Of force (rows 0 to 2) and torque (3 to 5) by position and rotation, and by velocity and angular
// velocity.
struct WrenchDerivative {
  Mat6 by_pose = Mat6::Zero();
  Mat6 by_twist = Mat6::Zero();
};

}  // namespace tw
