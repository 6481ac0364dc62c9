// Starting arcs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/successor.h"

#include <cmath>

#include "integrate/explicit/driven-arc.h"

namespace tw {

void start_new_arc(Successor& successor, const Key& key) {
  StateData& d = successor.data;
  successor.role = Role::new_arc;
  d.arc_key = key;
  d.arc_time = key.time;
  d.x = successor.point.x;
  d.q = successor.point.q;
  d.v = successor.point.v;
  // of a body that flies it is constant
  if (d.follows) d.L = angular_momentum(*successor.body, d.q, successor.point.w);
}

void let_fly(const Body& body, StateData& data) {
  data.follows = nullptr;
  data.flight = Flight(FreeRotation(body.moments, data.q, data.L),
                       {data.arc_time, data.x, data.v, data.acceleration});
}

Vec3 free_acceleration(const Successor& successor, double now) {
  const StateData& d = successor.data;
  if (!successor.body->dynamic()) return Vec3::Zero();
  if (!d.forces) return d.acceleration;
  return d.acceleration + d.forces->wrench(now, successor.point).force / successor.body->mass;
}

void let_move(const Scene& scene, const Body& body, StateData& data) {
  if (!data.forces && !scene.options.cash_karp) return let_fly(body, data);
  DrivenStart start;
  start.time = data.arc_time;
  start.mass = body.mass;
  start.moments = body.moments;
  start.size = body.extent();
  start.gravity = scene.gravity_scale();
  start.accuracy = scene.options.accuracy;
  start.x = data.x;
  start.q = data.q;
  start.v = data.v;
  start.L = data.L;
  start.acceleration = data.acceleration;
  start.forces = data.forces;
  if (scene.options.cash_karp) start.method = &cash_karp;
  start.name = body.info.name;
  start.place = body.info.place;
  data.follows = std::make_shared<DrivenArc>(start);
}

void take_velocities(Successor& successor, const ImpulseSlot& after) {
  successor.data.v = successor.point.v = after.v;
  successor.point.w = after.w;
  successor.data.L = angular_momentum(*successor.body, successor.point.q, after.w);
  if (successor.joints) successor.joints_changed = true;
}

}  // namespace tw
