// Scheme primitives: torques, drag, springs and forces by procedures.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/definitions.h"
#include "script/border.h"
#include "script/looking-view.h"
#include "script/primitive.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_forces)

namespace {

World& quiet_world_of(SCM body, const char* what) {
  require_outside_callbacks(what);
  return to_world(body_world(body));
}

std::optional<double> optional_real(SCM value, const char* name) {
  if (scm_is_false(value)) return std::nullopt;
  return to_real(value, name);
}

Vec3 point_or_origin(SCM value, const char* name) {
  return scm_is_false(value) ? Vec3(Vec3::Zero()) : to_vec3(value, name);
}

// What a force's procedure is handed: where the body would be, and no more.
class PlaceView final : public LookingView {
 public:
  explicit PlaceView(const BodyPose& pose) : LookingView(pose, "a force's procedure") {}
  double kinetic_energy() const override { refuse("its energy is not"); }
  const Vec3& applied_force() const override { refuse("its applied force is not"); }
  Vec3 applied_torque() const override { refuse("its applied torque is not"); }
  const SlotsPtr& slots() const override { refuse("its slots are not"); }
  SensedMotion sensed_motion() const override { refuse("what sensors read is not"); }
  std::vector<ContactReading> contacts() const override { refuse("its contacts are not"); }
  Wrench pull(BodyId, PullKind) const override { refuse("what pulls at it is not"); }
  bool attached(const StateView&) const override { refuse("what holds it is not"); }

 private:
  [[noreturn]] static void refuse(const char* what) {
    throw UserError(std::string("what a force is handed holds a pose and velocities only: ") +
                    what + " in it; expected position, orientation, velocity or angular-velocity");
  }
};

class ScmForce final : public ForceProcedure, Live<LiveKind::callback> {
 public:
  ScmForce(WorldBox& box, BodyId body, SCM procedure, Place place, std::uint64_t number)
      : box_(box), body_(body), procedure_(procedure), place_(std::move(place)), number_(number) {}

  std::uint64_t number() const override { return number_; }

  Wrench force(double time, const BodyState& body) override {
    const BodyPose pose{body_, body};
    PlaceView view(pose);
    SCM arguments[] = {scm_from_double(time), make_view(view, box_.handle)};
    const Kill kill{arguments[1]};
    const auto where = [&] {
      return "the force on " + box_.world.body(body_).name + " at " + show(time) + " s";
    };
    try {
      return read(call_scheme(procedure_, arguments), where);
    } catch (const SchemeError& error) {
      throw SchemeError(std::string(error.what()) + "\n  in " + where(),
                        error.place().known() ? error.place() : place_, error.backtrace());
    }
  }

 private:
  struct Kill {
    SCM view;
    ~Kill() { kill_view(view); }
  };

  // `where` tells which force it is, for messages.
  template <class Where>
  Wrench read(SCM result, Where where) const {
    Wrench wrench;
    const bool pair = scm_c_nvalues(result) == 2;
    TW_REQUIRE(pair || scm_c_nvalues(result) == 1,
               where() + " returned " + std::to_string(scm_c_nvalues(result)) +
                   " values; expected a force #(x y z), or two values, force and torque");
    try {
      wrench.force = to_vec3(pair ? scm_c_value_ref(result, 0) : result, "force");
      if (pair) wrench.torque = to_vec3(scm_c_value_ref(result, 1), "torque");
    } catch (const BadValue& bad) {
      throw UserError(where() + " returned a wrong " + bad.name + "; expected #(x y z), finite",
                      place_);
    }
    return wrench;
  }

  WorldBox& box_;
  BodyId body_;
  SCM procedure_;
  Place place_;
  std::uint64_t number_;
};

}  // namespace

TW_PRIMITIVE(applied_torque, "%applied-torque", (SCM object), "Applied torque, N m, world frame.") {
  if (is_view(object)) return from_vec3(to_view(object).applied_torque());
  if (!stands_for_body(object)) throw BadValue{"applied-torque", object, "a body or a view of one"};
  return from_vec3(quiet_world_of(object, "applied-torque").applied_torque(to_own_body(object)));
}

TW_PRIMITIVE(set_applied_torque, "%set-applied-torque!", (SCM object, SCM value),
             "Set the applied torque.") {
  const Vec3 torque = to_vec3(value, "applied-torque");
  const auto change = [&](StateView& view) { view.set_applied_torque(torque); };
  if (is_view(object)) {
    change(to_view(object));
    return SCM_UNSPECIFIED;
  }
  if (!stands_for_body(object)) throw BadValue{"applied-torque", object, "a body or a view of one"};
  quiet_world_of(object, "applied-torque").edit(to_own_body(object), change);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(add_drag, "%add-drag!", (SCM world, SCM body, SCM linear, SCM quadratic),
             "Let a body feel drag; return its addition.") {
  require_outside_callbacks("add-drag!");
  const BodyId id = to_body(world, body, "the body");
  const ForceHandle drag =
      to_world(world).add_drag(id, optional_real(linear, "linear").value_or(0),
                               optional_real(quadratic, "quadratic").value_or(0));
  return from_addition({drag}, world);
}

TW_PRIMITIVE(add_spring, "%add-spring!",
             (SCM world, SCM a, SCM b, SCM at_a, SCM at_b, SCM stiffness, SCM damping, SCM rest),
             "Hold two bodies together by a spring; return its addition.") {
  require_outside_callbacks("add-spring!");
  SpringDef spring;
  spring.a = to_body(world, a, "the first body");
  spring.b = to_body(world, b, "the second body");
  spring.at_a = point_or_origin(at_a, "at-a");
  spring.at_b = point_or_origin(at_b, "at-b");
  spring.stiffness = to_real(stiffness, "stiffness");
  spring.damping = optional_real(damping, "damping").value_or(0);
  spring.rest = optional_real(rest, "rest");
  return from_addition({to_world(world).add_spring(spring)}, world);
}

namespace {

// The two as views in a callback, or as bodies of the world outside; calls the one or the other.
template <class OfViews, class OfBodies>
void with_both(SCM world, SCM a, SCM b, const char* what, OfViews&& of_views,
               OfBodies&& of_bodies) {
  if (is_view(a) || is_view(b)) {
    for (const SCM object : {a, b})
      if (!is_view(object))
        throw BadValue{"one of the two", object,
                       "a view, as the other one is: make it a target of the callback"};
    StateView &view_a = to_view(a), &view_b = to_view(b);
    return of_views(view_a, view_b);
  }
  require_outside_callbacks(what);
  const BodyId id_a = to_body(world, a, "the first body");
  of_bodies(to_world(world), id_a, to_body(world, b, "the second body"));
}

}  // namespace

TW_PRIMITIVE(attach, "%attach!", (SCM world, SCM a, SCM b, SCM at, SCM stiffness, SCM damping),
             "Hold two bodies as they are.") {
  HoldDef hold;
  if (scm_is_true(at)) hold.at = to_vec3(at, "at");
  hold.stiffness = optional_real(stiffness, "stiffness");
  hold.damping = optional_real(damping, "damping");
  with_both(
      world, a, b, "attach!",
      [&](StateView& view_a, StateView& view_b) { view_a.attach(view_b, hold); },
      [&](World& w, BodyId id_a, BodyId id_b) { w.attach(id_a, id_b, hold); });
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(detach, "%detach!", (SCM world, SCM a, SCM b), "Let go of a held pair.") {
  with_both(
      world, a, b, "detach!", [](StateView& view_a, StateView& view_b) { view_a.detach(view_b); },
      [](World& w, BodyId id_a, BodyId id_b) { w.detach(id_a, id_b); });
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(attached, "%attached?", (SCM world, SCM a, SCM b), "Whether two are held together.") {
  bool held = false;
  with_both(
      world, a, b, "attached?",
      [&](StateView& view_a, StateView& view_b) { held = view_a.attached(view_b); },
      [&](World& w, BodyId id_a, BodyId id_b) { held = w.attached(id_a, id_b); });
  return scm_from_bool(held);
}

TW_PRIMITIVE(add_force, "%add-force!", (SCM world, SCM body, SCM procedure, SCM place),
             "Let a procedure act on a body; return its addition.") {
  require_outside_callbacks("add-force!");
  const BodyId id = to_body(world, body, "the body");
  if (scm_is_false(scm_procedure_p(procedure)))
    throw BadValue{"the force", procedure, "a procedure of the time and a view"};
  keep_with_world(world, procedure);
  WorldBox& box = to_world_box(world);
  const ForceHandle force = box.world.add_force(
      id, std::make_shared<ScmForce>(box, id, procedure,
                                     is_place(place) ? to_place(place) : Place{}, box.forces + 1));
  ++box.forces;
  return from_addition({force}, world);
}

}  // namespace tw
