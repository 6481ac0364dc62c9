// Motion of a kinematic body by a Scheme procedure of time.
//
// The procedure must be pure and returns position and orientation as two values.  Its speed bound
// holds for every point of the body's surface; it is verified at every call, against the call
// before.  Velocities are central differences of the pose.
//
// Cost: one call into Guile per pose, two more per velocity.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include "geometry/shape.h"
#include "integrate/trajectory.h"
#include "script/live.h"

namespace tw {

class ScmMotion : public Trajectory, Live<LiveKind::motion> {
 public:
  // `shape` may be null; else it must be bounded.  max_speed in m/s, finite, not negative.
  ScmMotion(SCM procedure, double max_speed, ShapePtr shape);

  Pose pose(double time) const override;
  Twist twist(double time) const override;
  MotionBounds bounds(double from, double to) const override;

 private:
  Pose call(double time) const;
  void verify(double time, const Pose& pose) const;
  // The farthest that a point of the surface is from where it was.
  double displacement(const Pose& from, const Pose& to) const;

  SCM procedure_;
  double max_speed_;
  ShapePtr shape_;
  double origin_speed_, angular_speed_;  // bounds that follow from max_speed
  // the last pose that was asked for: saves calls, changes no bit
  mutable bool has_last_ = false;
  mutable double last_time_ = 0;
  mutable Pose last_pose_;
};

}  // namespace tw
