// The bodies of a cluster that is stepped, as looks and sweeps see them.
//
// Frames: of a member the frame of its shape, whose origin need not be the centre of mass.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <vector>

#include "geometry/shape.h"
#include "integrate/trajectory.h"

namespace tw {

// A body that the cluster moves, at its start.
struct StepMember {
  ShapePtr shape;
  double mass = 1;                  // kg
  Mat3 inertia = Mat3::Identity();  // about the centre of mass, shape's frame, kg m^2
  Vec3 center = Vec3::Zero();       // of mass, shape's frame, m
  double radius = 1;                // of the ball about the centre of mass that holds the body, m
  double size = 1;                  // m, the lesser width: what depths and gaps are measured by
  Vec3 x = Vec3::Zero();            // of the centre of mass
  Quat q = Quat::Identity();
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
  Vec3 force = Vec3::Zero();   // constant, weight included, N
  Vec3 torque = Vec3::Zero();  // constant, about the centre, N m
};

// One that it meets and does not move.
struct StepOutside {
  ShapePtr shape;
  Pose pose;
  TrajectoryPtr motion;  // of the shape's frame; null: it stands at `pose`
};

// Both, while steps are made.
struct StepBody {
  const Shape* shape = nullptr;
  bool moves = false;                  // it is a member
  const Trajectory* motion = nullptr;  // of what is driven
  Frame frame;                         // of its shape
  Vec3 x = Vec3::Zero();               // centre of mass; of others the frame's origin
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
  double radius = 0;
  double size = std::numeric_limits<double>::infinity();
  // From the last look to where it is now, and from there to the end of the step to come, by its
  // velocity and weight: of the centre, and how far any point turns beside that, m.
  Vec3 moved = Vec3::Zero(), to_move = Vec3::Zero();
  double turned = 0, to_turn = 0;
  Frame ahead;  // as it will be in the middle of that step
};

}  // namespace tw
