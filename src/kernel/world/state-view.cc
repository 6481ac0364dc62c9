// What callbacks and edits see of a successor, and change in it.
//
// Source: the paper, section 4.6.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/state-view.h"

#include "base/limits.h"
#include "base/random.h"
#include "groups/joints/joints.h"
#include "integrate/anchored-bond.h"
#include "kernel/world/bonds.h"
#include "kernel/world/joint-changes.h"

namespace tw {

void require_near(const Vec3& position, const std::string& name) {
  TW_REQUIRE(position.cwiseAbs().maxCoeff() <= farthest,
             "position of " + name + " has a coordinate of " +
                 show(position.cwiseAbs().maxCoeff()) + " m; expected at most " + show(farthest) +
                 " m");
}

void SuccessorView::require_dynamic(const char* what) const {
  const Body& body = *successor_.body;
  const char* const why =
      body.fixed()
          ? "fixed; expected a dynamic body (remove-body!, and add-body! where it is to stand, "
            "puts a fixed one elsewhere)"
          : "kinematic: its #:motion says where it is at every time; expected a dynamic body, or a "
            "#:motion (keyframes or a procedure) that goes there, given by add-body! after "
            "remove-body!";
  TW_REQUIRE(body.dynamic(),
             std::string(what) + " of " + body.info.name + " cannot be changed, which is " + why);
}

void SuccessorView::require_no_link(const char* what) const {
  TW_REQUIRE(!successor_.body->multibody, std::string(what) + " of " + successor_.body->info.name +
                                              " cannot be set; it is a link of " +
                                              successor_.body->multibody->name +
                                              ", expected a change of its joints");
}

void SuccessorView::change_joints(const std::function<void(MultibodyState&)>& change) {
  TW_REQUIRE(successor_.joints,
             successor_.body->info.name + " has no joints; expected a link of a multibody");
  MultibodyState changed = *successor_.joints;
  change(changed);
  if (changed == *successor_.joints) return;
  check_joints(*successor_.body->multibody, *successor_.joints, key_.time, is_edit_, changed);
  start_arc();
  const bool placed = changed.q != successor_.joints->q;
  const bool moved = placed || changed.u != successor_.joints->u;
  successor_.placed = successor_.placed || placed;
  successor_.joints_changed = successor_.joints_changed || moved;
  *successor_.joints = std::move(changed);
  if (!moved) return;
  successor_.point = PlacedJoints(*successor_.body->multibody, *successor_.joints, key_.time)
                         .link(static_cast<int>(successor_.body->link));
  state_ = body_state(*successor_.body, successor_.point);
}

double SuccessorView::kinetic_energy() const {
  return tw::kinetic_energy(*successor_.body, successor_.point);
}

// The first change of the motion starts a new arc here.
void SuccessorView::start_arc() {
  if (!successor_.starts_arc()) start_new_arc(successor_, key_);
}

void SuccessorView::set_velocity(const Vec3& v) {
  require_dynamic("velocity");
  require_no_link("velocity");
  TW_REQUIRE(is_finite(v), "velocity of " + successor_.body->info.name + " is not finite");
  TW_REQUIRE(v.norm() <= speed_limit, "the speed of " + successor_.body->info.name + " is " +
                                          show(v.norm()) + " m/s; expected at most " +
                                          show(speed_limit));
  if (is_edit_ && v == state_.velocity) return;
  start_arc();
  successor_.data.v = successor_.point.v = state_.velocity = v;
}

void SuccessorView::set_angular_velocity(const Vec3& w) {
  require_dynamic("angular-velocity");
  require_no_link("angular-velocity");
  TW_REQUIRE(is_finite(w), "angular-velocity of " + successor_.body->info.name + " is not finite");
  TW_REQUIRE(w.norm() <= greatest_angular_speed,
             "the angular velocity of " + successor_.body->info.name + " is " + show(w.norm()) +
                 " rad/s; expected at most " + show(greatest_angular_speed));
  if (is_edit_ && w == state_.angular_velocity) return;
  start_arc();
  successor_.point.w = state_.angular_velocity = w;
  successor_.data.L = angular_momentum(*successor_.body, successor_.data.q, w);
}

void SuccessorView::set_applied_force(const Vec3& force) {
  require_dynamic("applied-force");
  TW_REQUIRE(is_finite(force), "applied-force of " + successor_.body->info.name + " is not finite");
  TW_REQUIRE(force.norm() / successor_.body->mass <= greatest_acceleration,
             "applied-force of " + successor_.body->info.name + " is " + show(force.norm()) +
                 " N on " + show(successor_.body->mass) +
                 " kg; expected an acceleration of at most " + show(greatest_acceleration) +
                 " m/s^2");
  if (force == successor_.data.force) return;
  start_arc();
  successor_.data.force = force;
  successor_.data.acceleration = scene_.options.gravity + force / successor_.body->mass;
}

Vec3 SuccessorView::applied_torque() const {
  const ForcesPtr& forces = successor_.data.forces;
  return forces ? forces->torque() : Vec3(Vec3::Zero());
}

void SuccessorView::set_applied_torque(const Vec3& torque) {
  require_dynamic("applied-torque");
  const Body& body = *successor_.body;
  TW_REQUIRE(is_finite(torque), "applied-torque of " + body.info.name + " is #(" +
                                    show(torque.x()) + " " + show(torque.y()) + " " +
                                    show(torque.z()) + "); expected three finite numbers");
  const double most = torque.norm() / body.moments.minCoeff();
  TW_REQUIRE(most <= greatest_angular_acceleration,
             "applied-torque of " + body.info.name + " is " + show(torque.norm()) +
                 " N m on a moment of inertia of " + show(body.moments.minCoeff()) +
                 " kg m^2; expected an angular acceleration of at most " +
                 show(greatest_angular_acceleration) + " rad/s^2");
  if (torque == applied_torque()) return;
  start_arc();
  successor_.data.forces = with_torque(successor_.data.forces, torque);
}

void SuccessorView::add_force(ForceLawPtr law) {
  require_dynamic("a force on it, that");
  start_arc();
  successor_.data.forces = with_law(successor_.data.forces, std::move(law));
}

std::shared_ptr<const void> SuccessorView::tie(SuccessorView& other, const Bond& bond) {
  const Body &mine = *successor_.body, &theirs = *other.successor_.body;
  const bool both = mine.dynamic() && theirs.dynamic();
  const BondPtr shared = both ? std::make_shared<Bond>(bond) : nullptr;
  std::shared_ptr<const void> tied = shared;
  for (SuccessorView* view : {this, &other}) {
    if (!view->successor_.body->dynamic()) continue;
    view->start_arc();
    ForcesPtr& forces = view->successor_.data.forces;
    if (both) {
      forces = with_bond(forces, shared);
      continue;
    }
    const Body& anchor = mine.dynamic() ? theirs : mine;
    const ForceLawPtr law = make_anchored_bond(bond, anchor.motion, anchor.fixed());
    forces = with_law(forces, law);
    tied = law;
  }
  return tied;
}

void SuccessorView::let_go(const void* law_or_bond) {
  if (!has(successor_.data.forces, law_or_bond)) return;
  start_arc();
  successor_.data.forces = without(successor_.data.forces, law_or_bond);
}

void SuccessorView::attach(StateView& view, const HoldDef& hold) {
  auto& other = static_cast<SuccessorView&>(view);
  tie(other, make_hold(scene_, successor_, other.successor_, hold));
}

void SuccessorView::detach(StateView& view) {
  auto& other = static_cast<SuccessorView&>(view);
  TW_REQUIRE(attached(other), successor_.body->info.name + " and " +
                                  other.successor_.body->info.name +
                                  " are not held together; expected two that attach! holds");
  for (SuccessorView* one : {this, &other}) {
    if (!one->successor_.body->dynamic()) continue;
    one->start_arc();
    ForcesPtr& forces = one->successor_.data.forces;
    forces = without_holds(forces, body(), other.body());
  }
}

bool SuccessorView::attached(const StateView& other) const {
  const Successor& theirs = static_cast<const SuccessorView&>(other).successor_;
  const Successor& holder = successor_.body->dynamic() ? successor_ : theirs;
  return holds(holder.data.forces, body(), other.body());
}

SensedMotion SuccessorView::sensed_motion() const {
  return sense_motion(scene_, *successor_.body, before_, key_.time);
}

std::vector<ContactReading> SuccessorView::contacts() const {
  TW_REQUIRE(successor_.body->dynamic(),
             "the contacts of " + successor_.body->info.name +
                 " were asked for through its view; expected a view of a dynamic body that touches "
                 "it (this one is " +
                 (successor_.body->fixed() ? "fixed)" : "kinematic)"));
  return contacts_of(*successor_.body, before_, key_.time);
}

Wrench SuccessorView::pull(BodyId other, PullKind kind) const {
  return sense_pull(*successor_.body, before_, other, kind, key_.time);
}

Wrench SuccessorView::joint_load(int link) const {
  return sense_joint(*successor_.body, before_, link, key_.time);
}

void SuccessorView::set_slots(SlotsPtr slots) { successor_.data.slots = std::move(slots); }

void SuccessorView::set_pose(const Vec3& position, const Quat& orientation) {
  TW_ASSERT(is_edit_, "set_pose is for edits");
  require_dynamic("position or orientation");
  require_no_link("position or orientation");
  TW_REQUIRE(is_finite(position), "position of " + successor_.body->info.name + " is not finite");
  require_near(position, successor_.body->info.name);
  TW_REQUIRE(is_finite(orientation) && orientation.squaredNorm() > 0,
             "orientation of " + successor_.body->info.name + " is zero or not finite");
  if (position == state_.position && orientation.coeffs() == state_.orientation.coeffs()) return;
  start_arc();
  successor_.placed = true;
  const Quat q = orientation.normalized();
  const Vec3 w = successor_.point.w;
  successor_.data.q = successor_.point.q = q * successor_.body->X_BP.q;
  successor_.data.x = successor_.point.x = position + q * successor_.body->X_BP.p;
  successor_.data.L = angular_momentum(*successor_.body, successor_.data.q, w);
  state_ = body_state(*successor_.body, successor_.point);
}

double SuccessorView::draw_random() {
  TW_REQUIRE(successor_.enters() || successor_.data.slots || successor_.body->dynamic(),
             "random-real! of " + successor_.body->info.name +
                 ": a fixed body without slots keeps no state; expected one with #:slots");
  Random random(successor_.data.random);
  const double x = random.real();
  successor_.data.random += 0x9e3779b97f4a7c15ull;
  return x;
}

}  // namespace tw
