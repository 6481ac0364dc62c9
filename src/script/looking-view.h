// A view that looks, and refuses to change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "kernel/world/callback.h"

namespace tw {

class LookingView : public StateView {
 public:
  // `caller`: who is handed it, for messages: "an observer".
  LookingView(const BodyPose& pose, const char* caller) : pose_(&pose), caller_(caller) {}
  BodyId body() const override { return pose_->body; }
  const BodyState& state() const override { return pose_->state; }

  void set_velocity(const Vec3&) override { refuse_change(); }
  void set_angular_velocity(const Vec3&) override { refuse_change(); }
  void set_applied_force(const Vec3&) override { refuse_change(); }
  void set_applied_torque(const Vec3&) override { refuse_change(); }
  void add_force(ForceLawPtr) override { refuse_change(); }
  void set_slots(SlotsPtr) override { refuse_change(); }
  void change_joints(const std::function<void(MultibodyState&)>&) override { refuse_change(); }
  void attach(StateView&, const HoldDef&) override { refuse_change(); }
  void detach(StateView&) override { refuse_change(); }
  void set_pose(const Vec3&, const Quat&) override { refuse_change(); }
  double draw_random() override { refuse_change(); }

 private:
  [[noreturn]] void refuse_change() const {
    throw UserError(std::string("a body was changed in ") + caller_ +
                    "; expected it to look only, and callbacks to change");
  }
  const BodyPose* pose_;
  const char* caller_;
};

}  // namespace tw
