// Scheme primitives: what sensors on a body read, and rays from it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/primitive.h"
#include "script/states.h"
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

}  // namespace

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
