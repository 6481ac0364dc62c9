// From how a body comes into a world to the body and the state it is born in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/make-body.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/limits.h"
#include "dynamics/placed-body.h"
#include "geometry/mass-properties.h"
#include "integrate/standing.h"
#include "kernel/world/state-view.h"
#include "timeline/key.h"

namespace tw {
namespace {

void require_finite(const Vec3& v, const char* what, const std::string& name) {
  TW_REQUIRE(is_finite(v), std::string(what) + " of " + name + " is #(" + show(v.x()) + " " +
                               show(v.y()) + " " + show(v.z()) +
                               "); expected three finite numbers");
}

void validate(const BodyDef& def, const std::string& name) {
  require_finite(def.position, "position", name);
  require_finite(def.velocity, "velocity", name);
  require_finite(def.angular_velocity, "angular-velocity", name);
  TW_REQUIRE(def.velocity.norm() <= speed_limit, "the speed of " + name + " is " +
                                                     show(def.velocity.norm()) +
                                                     " m/s; expected at most " + show(speed_limit));
  require_near(def.position, name);
  TW_REQUIRE(def.angular_velocity.norm() <= greatest_angular_speed,
             "the angular velocity of " + name + " is " + show(def.angular_velocity.norm()) +
                 " rad/s; expected at most " + show(greatest_angular_speed));
  TW_REQUIRE(is_finite(def.orientation) && def.orientation.squaredNorm() > 0,
             "orientation of " + name + " is zero or not finite; expected a quaternion #(w x y z)");
  TW_REQUIRE(!(def.fixed && def.motion),
             name + " has both #:fixed? and #:motion; expected one of them");
  const bool moves = !def.fixed && !def.motion;
  TW_REQUIRE(moves || (def.velocity.isZero() && def.angular_velocity.isZero()),
             name + " is fixed or kinematic and has a velocity; expected a dynamic body");
  if (def.color) require_finite(*def.color, "color", name);
}

void resolve_shape(Body& body, const BodyDef& def) {
  if (!def.shape) return;
  body.shape_P = body.X_PB.p.isZero() && body.X_PB.q.coeffs() == Quat::Identity().coeffs()
                     ? def.shape
                     : place_shape(def.shape, body.X_PB);
  body.unbounded = !body.shape_P->bounded();
  body.radius = body.shape_P->radius_about_origin();
  body.least_width = body.shape_P->least_width();
  body.thickness = body.shape_P->thickness();
  const std::string& kind = body.shape_P->kind_name();
  TW_REQUIRE(!body.shape_P->is_ground() || !body.dynamic(),
             body.info.name + (body.unbounded ? " is a half-space" : " is a " + kind) +
                 " that moves freely; expected #:fixed? or #:motion");
  if (body.dynamic()) {
    int axis = 0;
    body.moments.minCoeff(&axis);
    body.girth = body.shape_P->radius_about_line(Vec3::Unit(axis));
    if (body.girth < answer::slender * body.radius) body.slender_axis = axis;
  }
  if (body.shape_P->has_lazy_parts()) return;
  const ConvexPart& part = body.shape_P->parts().front();
  const bool at_center = part.bound_center.norm() <= 1e-15 * part.bound_radius;
  if (body.shape_P->is_sphere() && at_center) body.sphere_radius = part.radius;
  if (body.fixed() && body.shape_P->is_half_space()) {
    const Frame frame(body.motion->pose(0));
    body.is_fixed_plane = true;
    body.plane_normal = frame.R * part.normal;
    body.plane_offset = part.offset + body.plane_normal.dot(frame.p);
  }
  TW_REQUIRE(!body.unbounded || !body.motion || body.motion->bounds(-never, never).turn == 0,
             body.info.name + " is a half-space that turns; expected a motion without rotation");
}

}  // namespace

std::unique_ptr<Body> make_body(const BodyDef& def, BodyId id, const std::string& name) {
  validate(def, name);
  auto body = std::make_unique<Body>();
  body->info = {id, name,      def.material, BodyKind::dynamic, def.shape,
                0,  def.color, def.visible,  def.place,         def.visual};
  body->contact = {id, def.material};
  if (def.fixed || def.motion) {
    body->info.kind = def.fixed ? BodyKind::fixed : BodyKind::kinematic;
    body->motion = def.motion;
    if (def.fixed) body->motion = make_standing({def.position, def.orientation.normalized()});
  } else {
    const RigidInertia inertia = resolve_inertia(
        {def.density, def.mass, def.inertia, def.center_of_mass}, def.shape.get(), name);
    body->mass = body->info.mass = inertia.mass;
    body->moments = inertia.moments;
    body->X_BP = inertia.X_BP;
    body->X_PB.q = inertia.X_BP.q.conjugate();
    body->X_PB.p = -(body->X_PB.q * inertia.X_BP.p);
  }
  resolve_shape(*body, def);
  return body;
}

void make_birth(const Body& body, const BodyDef& def, const Vec3& gravity, State& state) {
  state.arc_key = state.key;
  state.arc_time = state.key.time;
  state.slots = def.slots;
  if (!body.dynamic()) {
    state.follows = body.motion;
    return;
  }
  const Quat q = def.orientation.normalized();
  state.q = q * body.X_BP.q;
  state.x = def.position + q * body.X_BP.p;
  state.v = def.velocity;
  state.L = angular_momentum(body, state.q, def.angular_velocity);
  state.acceleration = gravity;
  let_fly(body, state);
}

}  // namespace tw
