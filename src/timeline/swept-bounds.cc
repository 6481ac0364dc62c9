// What a body sweeps along its arc.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/swept-bounds.h"

#include "base/constants.h"

namespace tw {
Aabb swept_bounds(const Body& body, const Trajectory& trajectory, double from, double to) {
  const MotionBounds bounds = trajectory.bounds(from, to);
  Aabb box = bounds.path;
  const double turn = bounds.turn > 0 ? bounds.turn * (to - from) : 0;
  const bool fits = trajectory.stepped() ? turn <= cost::hardly_turns : bounds.turn == 0;
  if (body.sphere_radius >= 0 || !fits) {
    box.grow(body.radius);
    return box;
  }
  // the body at its first attitude, grown by what it moves from there
  Frame attitude = trajectory.frame(from);
  attitude.p.setZero();
  Aabb shape = body.shape_P->bounds(attitude);
  shape.grow(turn * body.radius);
  return {shape.lo + box.lo, shape.hi + box.hi};
}

}  // namespace tw
