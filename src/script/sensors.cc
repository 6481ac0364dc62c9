// Scheme primitives: what sensors on a body, at joints, and of springs and holds read; rays.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/joints.h"
#include "script/primitive.h"
#include "script/states.h"
#include "script/types.h"
#include "script/values.h"

namespace tw {

TW_PRIMITIVES(define_sensors)

namespace {

// A vector of the world as a sensor shows it that is mounted so in the body's frame.
Vec3 as_mounted(const Vec3& v, const Quat& body, SCM orientation) {
  const Vec3 in_body = body.conjugate() * v;
  if (scm_is_false(orientation)) return in_body;
  return to_quat(orientation, "orientation").conjugate() * in_body;
}

Vec3 to_point(SCM at) { return scm_is_true(at) ? to_vec3(at, "at") : Vec3(Vec3::Zero()); }

// ---- joints, springs and holds ----

Wrench read_joint_load(SCM object, SCM name, const char* what) {
  const Jointed of = to_jointed(object, what);
  const int link = to_joint(of.multibody, name);
  if (is_view(object)) return to_view(object).joint_load(link);
  require_outside_callbacks(what);
  return of.world.joint_load(of.multibody.number, link, of.world.time());
}

// One of the two, and its number.
struct End {
  SCM object;
  SCM world;
  BodyId body;

  End(SCM o, const char* name)
      : object(o),
        world(is_view(o)           ? view_world(o)
              : stands_for_body(o) ? body_world(o)
                                   : throw BadValue{name, o, "a body or a view of one"}),
        body(is_view(o) ? to_view(o).body() : to_own_body(o)) {}
};

// On a, which must be a view in callbacks where it is dynamic; else b must.
Wrench read_pull(SCM object_a, SCM object_b, PullKind kind, const char* what) {
  const End a(object_a, "the first body"), b(object_b, "the second body");
  if (!scm_is_eq(a.world, b.world))
    throw BadValue{"the second body", object_b, "one of the first one's world"};
  const auto read = [&](const End& end, BodyId other) {
    if (is_view(end.object)) return to_view(end.object).pull(other, kind);
    require_outside_callbacks(what);
    const World& world = to_world(end.world);
    return world.pull(end.body, other, kind, world.time());
  };
  if (info_of(object_a).kind == BodyKind::dynamic) return read(a, b.body);
  // what is not dynamic feels what it does to the other
  const Wrench on_b = read(b, a.body);
  return {-on_b.force, -on_b.torque};
}

}  // namespace

TW_PRIMITIVE(joint_force, "%joint-force", (SCM object, SCM name),
             "Return the force through a joint on its link, N, world frame.") {
  return from_vec3(read_joint_load(object, name, "joint-force").force);
}

TW_PRIMITIVE(joint_moment, "%joint-moment", (SCM object, SCM name),
             "Return the torque through a joint on its link, about its frame's origin, N m.") {
  return from_vec3(read_joint_load(object, name, "joint-moment").torque);
}

TW_PRIMITIVE(spring_force, "%spring-force", (SCM a, SCM b),
             "Return the force of the springs between two bodies on the first, N.") {
  return from_vec3(read_pull(a, b, PullKind::springs, "spring-force").force);
}

TW_PRIMITIVE(hold_force, "%hold-force", (SCM a, SCM b),
             "Return the force of the hold between two bodies on the first, N.") {
  return from_vec3(read_pull(a, b, PullKind::holds, "hold-force").force);
}

TW_PRIMITIVE(hold_torque, "%hold-torque", (SCM a, SCM b),
             "Return the torque of the hold between two bodies on the first, N m.") {
  return from_vec3(read_pull(a, b, PullKind::holds, "hold-torque").torque);
}

TW_PRIMITIVE(accelerometer, "%accelerometer", (SCM body, SCM at, SCM orientation),
             "Return what an accelerometer reads, m/s^2, its own axes.") {
  const Vec3 point = to_point(at);
  const SensedMotion sensed = read_sensed(body, "accelerometer");
  return from_vec3(
      as_mounted(sensed.proper_acceleration(point), sensed.body.orientation, orientation));
}

TW_PRIMITIVE(gyro, "%gyro", (SCM body, SCM orientation),
             "Return what a gyroscope reads, rad/s, its own axes.") {
  const BodyState state = read_state(body, "gyro");
  return from_vec3(as_mounted(state.angular_velocity, state.orientation, orientation));
}

TW_PRIMITIVE(mounted_ray, "%mounted-ray", (SCM body, SCM at, SCM direction),
             "Return (point direction) in the world of a ray that is fixed to a body.") {
  const Vec3 point = to_point(at), way = to_vec3(direction, "direction");
  const BodyState state = read_state(body, "rangefinder");
  return scm_list_2(from_vec3(state.position + state.orientation * point),
                    from_vec3(state.orientation * way));
}

}  // namespace tw
