// A view of one body in a committed frame: it looks, and refuses to change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/world.h"

namespace tw {

class FrameView : public StateView {
 public:
  explicit FrameView(const BodyPose& pose) : pose_(&pose) {}
  BodyId body() const override { return pose_->body; }
  const BodyState& state() const override { return pose_->state; }
  double kinetic_energy() const override { refuse("its energy is not"); }
  const Vec3& applied_force() const override { refuse("its applied force is not"); }
  const SlotsPtr& slots() const override { refuse("its slots are not"); }
  void set_velocity(const Vec3&) override { refuse_change(); }
  void set_angular_velocity(const Vec3&) override { refuse_change(); }
  void set_applied_force(const Vec3&) override { refuse_change(); }
  void set_slots(SlotsPtr) override { refuse_change(); }
  void set_pose(const Vec3&, const Quat&) override { refuse_change(); }
  double draw_random() override { refuse_change(); }

 private:
  [[noreturn]] static void refuse(const char* what) {
    throw UserError(std::string("a frame holds poses and velocities only: ") + what +
                    " in it; expected position, orientation, velocity or angular-velocity");
  }
  [[noreturn]] static void refuse_change() {
    throw UserError(
        "a body was changed in an observer; expected observers to look only, and callbacks to "
        "change");
  }
  const BodyPose* pose_;
};

}  // namespace tw
