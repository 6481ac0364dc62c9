// Motion of a kinematic body by a Scheme procedure of time.
//
// The procedure must be pure and returns position and orientation as two values.  It is sampled
// span by span (integrate/given/sampled-motion.h); no point of the surface may be faster than its
// max-speed, which every two samples that follow each other are held against.  What the samples
// tell apart by it: a jump from a fast motion; and it bounds what they may miss.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <string>

#include "geometry/shape.h"
#include "integrate/given/motion-span.h"
#include "script/live.h"

namespace tw {

class ScmMotion : public MotionProcedure, Live<LiveKind::motion> {
 public:
  // `name`: the body's, may be empty.  `shape` may be null; else it must be bounded.  max_speed in
  // m/s, finite, not negative.
  ScmMotion(SCM procedure, const std::string& name, double max_speed, ShapePtr shape);

  std::string name() const override { return name_; }
  Pose pose(double time) const override;
  void require_speed(double from, const Pose& before, double to, const Pose& after) const override;
  double max_speed() const override { return max_speed_; }
  double size() const override { return shape_ ? shape_->least_width() : 1; }
  double radius() const override { return shape_ ? shape_->radius_about_origin() : 1; }

 private:
  SCM call(double time) const;
  // The farthest that a point of the surface is from where it was.
  double displacement(const Pose& from, const Pose& to) const;

  SCM procedure_;
  std::string name_;
  double max_speed_;
  ShapePtr shape_;
};

}  // namespace tw
