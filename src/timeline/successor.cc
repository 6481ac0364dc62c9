// Starting arcs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/successor.h"

namespace tw {

void start_new_arc(Successor& successor, const Key& key) {
  StateData& d = successor.data;
  successor.role = Role::new_arc;
  d.arc_key = key;
  d.arc_time = key.time;
  d.x = successor.point.x;
  d.q = successor.point.q;
  d.v = successor.point.v;
  // of an isolated body it is constant
  if (d.group) d.L = angular_momentum(*successor.body, d.q, successor.point.w);
}

void let_fly(const Body& body, StateData& data) {
  data.follows = nullptr;
  data.flight = Flight(FreeRotation(body.moments, data.q, data.L), body.turn_excess,
                       {data.arc_time, data.x, data.v, data.acceleration});
}

void take_velocities(Successor& successor, const ImpulseSlot& after) {
  successor.data.v = successor.point.v = after.v;
  successor.point.w = after.w;
  successor.data.L = angular_momentum(*successor.body, successor.point.q, after.w);
}

}  // namespace tw
