// A body as certificates see it: where it is, how it moves, and bounds on how that may change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "dynamics/placed-body.h"
#include "integrate/trajectory.h"

namespace tw {

// One body of the pair at the certificate's time.  What is integrated is seen as its pose moves.
struct MovingBody : PlacedBody {
  MotionBounds bounds;
  Vec3 acceleration;        // the middle of its bounds; none where the velocity may jump
  Vec3 spread;              // it differs from the middle by this at most
  bool by_speed = false;    // only its speeds are bounded
  double bend = 0;          // bound on |a point's acceleration against the centre's| / arm, 1/s^2
  double step_end = never;  // of the integrator's present step; `never`: the arc ends with it
  const Trajectory* path;
  double from, to;  // s, of the bounds

  MovingBody(const Body& b, const Trajectory& trajectory, double when)
      : PlacedBody(b, trajectory.path_at(when)), path(&trajectory), from(when), to(when) {
    step_end = trajectory.step_end(when);
    double until = trajectory.end();
    if (b.kinematic() || (until == never && step_end != never)) {
      // what goes on for ever, step by step or in spans, is bounded as narrowly as may be at once
      until = std::min(when + cost::kinematic_horizon, step_end);
      step_end = never;
    }
    bound_by(std::max(when, until));
  }
  // The same with the narrower bounds of the present step of the integrator.
  MovingBody within_step() const {
    MovingBody narrow = *this;
    if (step_end != never) narrow.bound_by(std::max(from, step_end));
    return narrow;
  }

  // The longer of two times in which no point may come too far along the unit n, given such a time
  // by a bound on the bend: along n that is no more than |n x w'| + |n x w| |w|.  What spins in a
  // plane stays in it.
  template <class Least>
  double longest_along(const Vec3& n, const Least& least) const {
    const double wide = least(bend);
    if (!(wide > 0 && wide < never) || by_speed) return wide;
    const double change = wide < cost::soon ? path->turn_change_across(n, from, to, bounds)
                                            : bounds.turn_change,
                 across = n.cross(point.w).norm();
    // n x w may have doubled by then
    const double until = change > 0 ? std::max(4 * wide, across / change) : never;
    const double growth = change > 0 ? change * until : 0;
    const double narrow = change + (across + growth) * bounds.turn;
    return narrow < 0.5 * bend ? std::max(wide, std::min(until, least(narrow))) : wide;
  }

 private:
  void bound_by(double until) {
    to = until;
    const MotionBounds& b = bounds = path->bounds(from, to);
    by_speed = b.velocity_may_jump();
    bend = b.turn_change + b.turn * b.turn;
    acceleration = by_speed ? Vec3(Vec3::Zero()) : b.acceleration.center();
    spread = by_speed ? Vec3(Vec3::Zero()) : Vec3(0.5 * b.acceleration.size());
  }
};

// Least s > 0 with gap + speed s + pull s^2/2 = 0; gap > 0.  Each branch without cancellation: just
// after an impact the gap is rounding and the speed is not.
inline double first_zero(double gap, double speed, double pull) {
  const double disc = speed * speed - 2 * pull * gap;
  if (disc < 0) return never;
  const double root = std::sqrt(disc);
  if (speed > 0) return pull < 0 ? (speed + root) / -pull : never;
  return root - speed > 0 ? 2 * gap / (root - speed) : never;
}

}  // namespace tw
