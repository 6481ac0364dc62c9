// The view of one body that an observer of frames is handed: it reads the world at the frame's
// time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "kernel/world/world.h"
#include "script/looking-view.h"

namespace tw {

class FrameView : public LookingView {
 public:
  FrameView(const BodyPose& pose, const World& world, double frame_time)
      : LookingView(pose, "an observer"), world_(&world), time_(frame_time) {}
  double kinetic_energy() const override { return world_->kinetic_energy(body(), time_); }
  const Vec3& applied_force() const override { return world_->applied_force(body(), time_); }
  Vec3 applied_torque() const override { return world_->applied_torque(body(), time_); }
  const SlotsPtr& slots() const override { return world_->slots(body(), time_); }
  SensedMotion sensed_motion() const override { return world_->sensed_motion(body(), time_); }
  std::vector<ContactReading> contacts() const override {
    return world_->contacts_of(body(), time_);
  }
  Wrench pull(BodyId other, PullKind kind) const override {
    return world_->pull(body(), other, kind, time_);
  }
  Wrench joint_load(int link) const override {
    return world_->joint_load(multibody()->number, link, time_);
  }
  const Multibody* multibody() const override {
    const std::optional<std::uint32_t> number = world_->multibody_of(body());
    return number ? &world_->multibody(*number) : nullptr;
  }
  const MultibodyState* joints() const override {
    if (!joints_ && multibody()) joints_ = world_->joints(multibody()->number, time_);
    return joints_ ? &*joints_ : nullptr;
  }
  double joints_time() const override { return time_; }
  bool attached(const StateView& other) const override {
    return world_->attached(body(), other.body(), time_);
  }

 private:
  const World* world_;
  double time_;
  mutable std::optional<MultibodyState> joints_;  // once asked for
};

}  // namespace tw
