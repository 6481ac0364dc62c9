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
  d.rotation_ready = false;
}

}  // namespace tw
