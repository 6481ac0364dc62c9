// A body as certificates see it: where it is, how it moves, and bounds on how that may change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "timeline/arc.h"

namespace tw {

// How far ahead the speed of a kinematic body is bounded, s.
inline constexpr double kinematic_horizon = 0.5;

// One body of the pair at the certificate's time.
struct MovingBody {
  const Body* body;
  Frame frame;
  PoseTwist point;
  double turn_bound = 0;   // W, rad/s
  double bend = 0;         // bound on |a point's acceleration against the centre's| / arm, 1/s^2
  double speed_bound = 0;  // kinematic: the origin's
  Vec3 acceleration = Vec3::Zero();
  Vec3 spread = Vec3::Zero();  // the acceleration differs from `acceleration` by this at most
  double horizon = never;      // bounds hold so far
  double step_end = never;     // of the integrator's present step; `never`: the arc ends with it

  MovingBody(const Body& b, const State& arc, double when) : body(&b) {
    if (arc.group && !arc.group->at_rest) {
      follow_group(arc, when);
      return;
    }
    point = evaluate(b, arc, when);
    frame = Frame(point.q.toRotationMatrix(), point.x);
    if (b.fixed() || arc.group) return;
    turn_bound = angular_speed_bound(b, arc, when, when + kinematic_horizon);
    bend = (1 + b.turn_excess) * turn_bound * turn_bound;
    if (b.dynamic())
      acceleration = arc.acceleration;
    else
      speed_bound = b.motion->speed_bound(when, when + kinematic_horizon);
  }
  // The dense output itself moves.
  void follow_group(const State& arc, double when) {
    const int member = static_cast<int>(arc.member);
    GroupArc& motion = *arc.group->arc;
    motion.pose(member, when, point.x, point.q);
    frame = Frame(point.q.toRotationMatrix(), point.x);
    motion.pose_rates(member, when, point.v, point.w);
    const double end = arc.group->end(arc.member);
    bound_by(arc, when, std::max(when, end));
    step_end = motion.step_end(when);
    if (step_end >= end) step_end = never;
  }
  // The same with the narrower bounds of the present step of the integrator.
  MovingBody within_step(const State& arc, double when) const {
    MovingBody narrow = *this;
    if (step_end == never) return narrow;
    narrow.bound_by(arc, when, std::max(when, step_end));
    narrow.horizon = std::max(when, step_end);
    return narrow;
  }
  void bound_by(const State& arc, double when, double until) {
    const GroupBounds bounds = arc.group->arc->bounds(static_cast<int>(arc.member), when, until);
    turn_bound = bounds.turn;
    bend = bounds.turn_change + bounds.turn * bounds.turn;
    acceleration = 0.5 * (bounds.acceleration.lo + bounds.acceleration.hi);
    spread = 0.5 * (bounds.acceleration.hi - bounds.acceleration.lo);
  }
  Vec3 velocity_at(const Vec3& world_point) const {
    return point.v + point.w.cross(world_point - point.x);
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
