// What callbacks and edits see of a successor, and change in it.
//
// Source: the paper, section 4.6.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "kernel/world/callback.h"
#include "timeline/successor.h"

namespace tw {

// UserError if a body called `name` were placed too far away (base/limits.h).
void require_near(const Vec3& position, const std::string& name);

// Reads the successor's point, writes the successor.
class SuccessorView : public StateView {
 public:
  // `before`: the state that it succeeds; outlives the view.
  SuccessorView(const Scene& scene, const State& before, Successor& successor, const Key& key,
                bool is_edit)
      : scene_(scene),
        before_(before),
        successor_(successor),
        key_(key),
        is_edit_(is_edit),
        state_(body_state(*successor.body, successor.point)) {}

  BodyId body() const override { return successor_.body->id(); }
  const BodyState& state() const override { return state_; }
  double kinetic_energy() const override;
  const Vec3& applied_force() const override { return successor_.data.force; }
  Vec3 applied_torque() const override;
  const SlotsPtr& slots() const override { return successor_.data.slots; }
  SensedMotion sensed_motion() const override;
  std::vector<ContactReading> contacts() const override;
  Wrench pull(BodyId other, PullKind kind) const override;
  Wrench joint_load(int link) const override;
  const Multibody* multibody() const override { return successor_.body->multibody; }
  const MultibodyState* joints() const override { return successor_.joints.get(); }
  double joints_time() const override { return key_.time; }
  void change_joints(const std::function<void(MultibodyState&)>& change) override;
  void set_velocity(const Vec3& v) override;
  void set_angular_velocity(const Vec3& w) override;
  void set_applied_force(const Vec3& force) override;
  void set_applied_torque(const Vec3& torque) override;
  void add_force(ForceLawPtr law) override;
  void set_slots(SlotsPtr slots) override;
  void attach(StateView& other, const HoldDef& hold) override;
  void detach(StateView& other) override;
  bool attached(const StateView& other) const override;
  // Ties the two from here on, by the bond or law that it returns.
  std::shared_ptr<const void> tie(SuccessorView& other, const Bond& bond);
  // Without that law or bond from here on, if it has it.
  void let_go(const void* law_or_bond);
  void set_pose(const Vec3& position, const Quat& orientation) override;
  double draw_random() override;

 private:
  void require_dynamic(const char* what) const;
  void require_no_link(const char* what) const;
  void start_arc();

  const Scene& scene_;
  const State& before_;
  Successor& successor_;
  Key key_;
  bool is_edit_;  // it may be placed elsewhere, and what changes nothing starts no arc
  BodyState state_;
};

}  // namespace tw
