// A view that looks, and refuses to change: of one body in a committed frame, or of one for which a
// procedure tells a force.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/world.h"

namespace tw {

class FrameView : public StateView {
 public:
  // `holder` and `caller`: "a frame", "an observer".
  // Of a frame of the world.
  FrameView(const BodyPose& pose, const World& world, double frame_time)
      : pose_(&pose), world_(&world), time_(frame_time) {}
  FrameView(const BodyPose& pose, const char* holder, const char* caller)
      : pose_(&pose), holder_(holder), caller_(caller) {}
  BodyId body() const override { return pose_->body; }
  const BodyState& state() const override { return pose_->state; }
  double kinetic_energy() const override { refuse("its energy is not"); }
  const Vec3& applied_force() const override { refuse("its applied force is not"); }
  Vec3 applied_torque() const override { refuse("its applied torque is not"); }
  const SlotsPtr& slots() const override { refuse("its slots are not"); }
  SensedMotion sensed_motion() const override {
    if (!world_) refuse("what sensors read is not");
    return world_->sensed_motion(pose_->body, time_);
  }
  std::vector<ContactReading> contacts() const override {
    if (!world_) refuse("its contacts are not");
    return world_->contacts_of(pose_->body, time_);
  }
  Wrench pull(BodyId other, PullKind kind) const override {
    if (!world_) refuse("what pulls at it is not");
    return world_->pull(pose_->body, other, kind, time_);
  }
  void set_velocity(const Vec3&) override { refuse_change(); }
  void set_angular_velocity(const Vec3&) override { refuse_change(); }
  void set_applied_force(const Vec3&) override { refuse_change(); }
  void set_applied_torque(const Vec3&) override { refuse_change(); }
  void add_force(ForceLawPtr) override { refuse_change(); }
  void set_slots(SlotsPtr) override { refuse_change(); }
  void set_pose(const Vec3&, const Quat&) override { refuse_change(); }
  double draw_random() override { refuse_change(); }

 private:
  [[noreturn]] void refuse(const char* what) const {
    throw UserError(std::string(holder_) + " holds poses and velocities only: " + what +
                    " in it; expected position, orientation, velocity or angular-velocity");
  }
  [[noreturn]] void refuse_change() const {
    throw UserError(std::string("a body was changed in ") + caller_ +
                    "; expected it to look only, and callbacks to change");
  }
  const BodyPose* pose_;
  const World* world_ = nullptr;
  double time_ = 0;
  const char *holder_ = "a frame", *caller_ = "an observer";
};

}  // namespace tw
