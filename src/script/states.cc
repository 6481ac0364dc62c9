// Scheme primitives: reading and changing what a body does, by its handle or through a view.
//
// A body is read at its world's time, a view at its event.  A body is changed by an edit of the
// world (a discontinuity at the world's time), a view by writing into the state that follows.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/states.h"

#include "script/primitive.h"
#include "script/scm-slots.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_states)

namespace {

constexpr const char* body_or_view = "a body or a view of one";

World& readable_world(SCM body, const char* what) {
  if (!stands_for_body(body)) throw BadValue{what, body, body_or_view};
  require_outside_callbacks(what);
  return to_world(body_world(body));
}

// For messages about `object`: "body ball".
std::string label(SCM object) {
  const BodyId id = is_view(object) ? to_view(object).body() : to_own_body(object);
  return "body " +
         to_world(is_view(object) ? view_world(object) : body_world(object)).body(id).name;
}

// Applies `change` to the state behind a view, or edits the body.
template <class Change>
SCM change_state(SCM object, const char* what, Change change) {
  if (is_view(object))
    change(to_view(object));
  else
    readable_world(object, what).edit(to_own_body(object), change);
  return SCM_UNSPECIFIED;
}

SlotsPtr read_slots(SCM object, const char* what) {
  if (is_view(object)) return to_view(object).slots();
  return readable_world(object, what).slots(to_own_body(object));
}

const ScmSlots* as_scm_slots(const SlotsPtr& slots) {
  return static_cast<const ScmSlots*>(slots.get());
}

// Index of a slot that must exist.
int find_slot(const SlotsPtr& slots, SCM object, SCM name) {
  const ScmSlots* known = as_scm_slots(slots);
  const int index = known ? known->find(name) : -1;
  TW_REQUIRE(index >= 0, label(object) + " has no slot " + to_symbol_name(name, "the slot's name") +
                             "; expected " +
                             (known && known->size() ? "one of: " + known->names_text()
                                                     : std::string("slots given by #:slots")));
  return index;
}

}  // namespace

BodyState read_state(SCM object, const char* what) {
  if (is_view(object)) return to_view(object).state();
  return readable_world(object, what).state(to_own_body(object));
}

SensedMotion read_sensed(SCM object, const char* what) {
  if (is_view(object)) return to_view(object).sensed_motion();
  const World& world = readable_world(object, what);
  return world.sensed_motion(to_own_body(object), world.time());
}

TW_PRIMITIVE(position, "%position", (SCM object), "Position of the body frame, m.") {
  return from_vec3(read_state(object, "position").position);
}

TW_PRIMITIVE(orientation, "%orientation", (SCM object), "Orientation of the body frame.") {
  return from_quat(read_state(object, "orientation").orientation);
}

TW_PRIMITIVE(velocity, "%velocity", (SCM object), "Velocity of the centre of mass, m/s.") {
  return from_vec3(read_state(object, "velocity").velocity);
}

TW_PRIMITIVE(angular_velocity, "%angular-velocity", (SCM object), "Angular velocity, rad/s.") {
  return from_vec3(read_state(object, "angular-velocity").angular_velocity);
}

TW_PRIMITIVE(kinetic_energy, "%kinetic-energy", (SCM object), "Kinetic energy, J.") {
  if (is_view(object)) return scm_from_double(to_view(object).kinetic_energy());
  const World& world = readable_world(object, "kinetic-energy");
  if (!is_multibody(object)) return scm_from_double(world.kinetic_energy(to_own_body(object)));
  double sum = 0;
  for (const BodyId link : to_own_multibody(object).links) sum += world.kinetic_energy(link);
  return scm_from_double(sum);
}

TW_PRIMITIVE(applied_force, "%applied-force", (SCM object), "Applied force, N, world frame.") {
  if (is_view(object)) return from_vec3(to_view(object).applied_force());
  return from_vec3(readable_world(object, "applied-force").applied_force(to_own_body(object)));
}

TW_PRIMITIVE(set_position, "%set-position!", (SCM object, SCM value), "Move a body.") {
  const Vec3 p = to_vec3(value, "position");
  TW_REQUIRE(!is_view(object),
             "the position of " + label(object) +
                 " was set through a view; expected only velocity, angular-velocity, slots and "
                 "applied forces to be set inside a callback");
  return change_state(object, "position",
                      [&](StateView& v) { v.set_pose(p, v.state().orientation); });
}

TW_PRIMITIVE(set_orientation, "%set-orientation!", (SCM object, SCM value), "Turn a body.") {
  const Quat q = to_quat(value, "orientation");
  TW_REQUIRE(!is_view(object),
             "the orientation of " + label(object) +
                 " was set through a view; expected only velocity, angular-velocity, slots and "
                 "applied forces to be set inside a callback");
  return change_state(object, "orientation",
                      [&](StateView& v) { v.set_pose(v.state().position, q); });
}

TW_PRIMITIVE(set_velocity, "%set-velocity!", (SCM object, SCM value), "Set the velocity.") {
  const Vec3 v = to_vec3(value, "velocity");
  return change_state(object, "velocity", [&](StateView& view) { view.set_velocity(v); });
}

TW_PRIMITIVE(set_angular_velocity, "%set-angular-velocity!", (SCM object, SCM value),
             "Set the angular velocity.") {
  const Vec3 w = to_vec3(value, "angular-velocity");
  return change_state(object, "angular-velocity",
                      [&](StateView& view) { view.set_angular_velocity(w); });
}

TW_PRIMITIVE(set_applied_force, "%set-applied-force!", (SCM object, SCM value),
             "Set the applied force.") {
  const Vec3 f = to_vec3(value, "applied-force");
  return change_state(object, "applied-force", [&](StateView& view) { view.set_applied_force(f); });
}

// ---- slots ----

TW_PRIMITIVE(slot_ref, "%slot", (SCM object, SCM name), "Return the value of a slot.") {
  const SlotsPtr slots = read_slots(object, "slot");
  return as_scm_slots(slots)->value(find_slot(slots, object, name));
}

TW_PRIMITIVE(has_slot, "%slot?", (SCM object, SCM name), "Has the body such a slot?") {
  const SlotsPtr slots = read_slots(object, "slot?");
  return scm_from_bool(slots && as_scm_slots(slots)->find(name) >= 0);
}

TW_PRIMITIVE(slot_values, "%slot-values", (SCM view), "Return the values of all slots of a view.") {
  const SlotsPtr slots = read_slots(view, "slot");
  SCM list = SCM_EOL;
  for (std::size_t i = slots ? as_scm_slots(slots)->size() : 0; i-- > 0;)
    list = scm_cons(as_scm_slots(slots)->value(static_cast<int>(i)), list);
  return list;
}

TW_PRIMITIVE(set_slot, "%set-slot!", (SCM object, SCM name, SCM value), "Set a slot.") {
  return change_state(object, "slot", [&](StateView& view) {
    const SlotsPtr slots = view.slots();
    const int index = find_slot(slots, object, name);
    SlotsPtr changed = as_scm_slots(slots)->with(index, value);
    // an edit of nothing is none; what a callback sets is told by its record
    if (!is_view(object) && as_scm_slots(slots)->has_same(index, *as_scm_slots(changed))) return;
    view.set_slots(std::move(changed));
  });
}

// ---- random numbers ----

TW_PRIMITIVE(random_real, "%random-real!", (SCM object), "Draw a number from [0, 1).") {
  double drawn = 0;
  change_state(object, "random-real!", [&](StateView& view) { drawn = view.draw_random(); });
  return scm_from_double(drawn);
}

}  // namespace tw
