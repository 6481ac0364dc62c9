// What stands still.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/standing.h"

namespace tw {
namespace {

class Standing final : public Trajectory {
 public:
  Standing(const Pose& pose, bool carried) : pose_(pose), carried_(carried) { path_.x = pose.p; }
  Pose pose(double) const override { return pose_; }
  Twist twist(double) const override { return {}; }
  MotionBounds bounds(double, double) const override {
    MotionBounds bounds;
    bounds.path = {pose_.p, pose_.p};
    bounds.acceleration = {Vec3::Zero(), Vec3::Zero()};
    return bounds;
  }
  const Parabola* ballistic() const override { return carried_ ? nullptr : &path_; }

 private:
  Pose pose_;
  Parabola path_;
  bool carried_;
};

}  // namespace

TrajectoryPtr make_standing(const Pose& pose) { return std::make_shared<Standing>(pose, false); }

TrajectoryPtr make_resting(const Pose& pose) { return std::make_shared<Standing>(pose, true); }

}  // namespace tw
