// Drafts: new states of the receivers of a discontinuity before they enter the graph, and what
// callbacks see of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "kernel/arc.h"
#include "kernel/body.h"
#include "kernel/state.h"

namespace tw {

struct Draft {
  const Body* body = nullptr;
  bool enters = true;    // false: a fixed body that keeps no states
  bool watched = false;  // what happens to others depends on it, but it doesn't touch them
  bool placed = false;   // somebody put it elsewhere: its contacts are gone
  StateData data;
  ArcPoint point;  // at the discontinuity's time
};

// Starts a new arc at `key` from the draft's point; the group, if there is one, is still the old
// one.
void start_new_arc(Draft& draft, const Key& key);

// UserError if a body called `name` were placed too far away (base/limits.h).
void require_near(const Vec3& position, const std::string& name);

// What a callback or edit sees: reads the draft's point, writes the draft.
class DraftView : public StateView {
 public:
  DraftView(Draft& draft, const Key& key, bool may_place, const Vec3& gravity)
      : draft_(draft),
        key_(key),
        may_place_(may_place),
        gravity_(gravity),
        state_(body_state(*draft.body, draft.point)) {}

  BodyId body() const override { return draft_.body->id(); }
  const BodyState& state() const override { return state_; }
  double kinetic_energy() const override;
  const Vec3& applied_force() const override { return draft_.data.force; }
  const SlotsPtr& slots() const override { return draft_.data.slots; }
  void set_velocity(const Vec3& v) override;
  void set_angular_velocity(const Vec3& w) override;
  void set_applied_force(const Vec3& force) override;
  void set_slots(SlotsPtr slots) override;
  void set_pose(const Vec3& position, const Quat& orientation) override;
  double draw_random() override;

 private:
  void require_dynamic(const char* what) const;
  void start_arc();

  Draft& draft_;
  Key key_;
  bool may_place_;
  Vec3 gravity_;
  BodyState state_;
};

}  // namespace tw
