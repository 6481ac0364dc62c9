// What callbacks and edits see of a draft, and change in it.
//
// Source: the paper, section 4.6.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/draft.h"

#include "base/limits.h"
#include "base/random.h"

namespace tw {

void require_near(const Vec3& position, const std::string& name) {
  TW_REQUIRE(position.cwiseAbs().maxCoeff() <= farthest,
             "position of " + name + " has a coordinate of " +
                 show(position.cwiseAbs().maxCoeff()) + " m; expected at most " + show(farthest) +
                 " m");
}

void start_new_arc(Draft& draft, const Key& key) {
  StateData& d = draft.data;
  d.arc_key = key;
  d.arc_time = key.time;
  d.x = draft.point.x;
  d.q = draft.point.q;
  d.v = draft.point.v;
  // of an isolated body it is constant
  if (d.group) d.L = angular_momentum(*draft.body, d.q, draft.point.w);
  d.rotation_ready = false;
}

void DraftView::require_dynamic(const char* what) const {
  TW_REQUIRE(draft_.body->dynamic(),
             std::string(what) + " of " + draft_.body->info.name +
                 " cannot be changed; expected a dynamic body (this one is " +
                 (draft_.body->fixed() ? "fixed)" : "kinematic)"));
}

double DraftView::kinetic_energy() const { return tw::kinetic_energy(*draft_.body, draft_.point); }

// The first change of the motion starts a new arc here.
void DraftView::start_arc() {
  if (draft_.data.arc_key != key_) start_new_arc(draft_, key_);
}

void DraftView::set_velocity(const Vec3& v) {
  require_dynamic("velocity");
  TW_REQUIRE(is_finite(v), "velocity of " + draft_.body->info.name + " is not finite");
  TW_REQUIRE(v.norm() <= speed_limit, "the speed of " + draft_.body->info.name + " is " +
                                          show(v.norm()) + " m/s; expected at most " +
                                          show(speed_limit));
  start_arc();
  draft_.data.v = draft_.point.v = state_.velocity = v;
}

void DraftView::set_angular_velocity(const Vec3& w) {
  require_dynamic("angular-velocity");
  TW_REQUIRE(is_finite(w), "angular-velocity of " + draft_.body->info.name + " is not finite");
  TW_REQUIRE(w.norm() <= greatest_angular_speed,
             "the angular velocity of " + draft_.body->info.name + " is " + show(w.norm()) +
                 " rad/s; expected at most " + show(greatest_angular_speed));
  start_arc();
  draft_.point.w = state_.angular_velocity = w;
  draft_.data.L = angular_momentum(*draft_.body, draft_.data.q, w);
}

void DraftView::set_applied_force(const Vec3& force) {
  require_dynamic("applied-force");
  TW_REQUIRE(is_finite(force), "applied-force of " + draft_.body->info.name + " is not finite");
  TW_REQUIRE(force.norm() / draft_.body->mass <= greatest_acceleration,
             "applied-force of " + draft_.body->info.name + " is " + show(force.norm()) + " N on " +
                 show(draft_.body->mass) + " kg; expected an acceleration of at most " +
                 show(greatest_acceleration) + " m/s^2");
  if (force == draft_.data.force) return;
  start_arc();
  draft_.data.force = force;
  draft_.data.acceleration = gravity_ + force / draft_.body->mass;
}

void DraftView::set_slots(SlotsPtr slots) { draft_.data.slots = std::move(slots); }

void DraftView::set_pose(const Vec3& position, const Quat& orientation) {
  TW_ASSERT(may_place_, "set_pose is for edits");
  require_dynamic("position");
  TW_REQUIRE(is_finite(position), "position of " + draft_.body->info.name + " is not finite");
  require_near(position, draft_.body->info.name);
  TW_REQUIRE(is_finite(orientation) && orientation.squaredNorm() > 0,
             "orientation of " + draft_.body->info.name + " is zero or not finite");
  start_arc();
  draft_.placed = true;
  const Quat q = orientation.normalized();
  const Vec3 w = draft_.point.w;
  draft_.data.q = draft_.point.q = q * draft_.body->X_BP.q;
  draft_.data.x = draft_.point.x = position + q * draft_.body->X_BP.p;
  draft_.data.L = angular_momentum(*draft_.body, draft_.data.q, w);
  state_ = body_state(*draft_.body, draft_.point);
}

double DraftView::draw_random() {
  TW_REQUIRE(draft_.enters || draft_.data.slots || draft_.body->dynamic(),
             "random-real! of " + draft_.body->info.name +
                 ": a fixed body without slots keeps no state; expected one with #:slots");
  Random random(draft_.data.random);
  const double x = random.real();
  draft_.data.random += 0x9e3779b97f4a7c15ull;
  return x;
}

}  // namespace tw
