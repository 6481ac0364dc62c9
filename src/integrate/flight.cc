// Free flight.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/flight.h"

#include <algorithm>

namespace tw {

Pose Flight::pose(double time) const {
  return {path_.position(time), rotation_.attitude(time - path_.start)};
}

Twist Flight::twist(double time) const {
  const PoseTwist there = at(time);
  return {there.v, there.w};
}

PoseTwist Flight::at(double time) const {
  PoseTwist point;
  const double s = time - path_.start;
  point.x = path_.x + s * (path_.v + (0.5 * s) * path_.acceleration);
  point.v = path_.v + s * path_.acceleration;
  rotation_.evaluate(s, point.q, point.w);
  return point;
}

MotionBounds Flight::bounds(double from, double to) const {
  MotionBounds bounds;
  bounds.acceleration = {path_.acceleration, path_.acceleration};
  bounds.turn = rotation_.max_angular_speed();
  bounds.turn_change = rotation_.max_angular_acceleration();
  bounds.speed = never;
  if (to == never) {
    bounds.path = Aabb::everywhere();
    return bounds;
  }
  // extremes at the ends and where a coordinate turns
  bounds.path.add(path_.position(from));
  bounds.path.add(path_.position(to));
  for (int i = 0; i < 3; ++i) {
    const double a = path_.acceleration[i];
    if (a == 0) continue;
    const double apex = path_.start - path_.v[i] / a;
    if (apex > from && apex < to) bounds.path.add(path_.position(apex));
  }
  return bounds;
}

}  // namespace tw
