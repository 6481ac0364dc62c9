// Evaluating and bounding arcs: what moves between discontinuities.
//
// Isolated dynamic bodies fly freely: x(t) = x0 + v0 s + a s^2/2 with s = t - arc_time, and
// torque-free rotation in closed form.  Members of contact groups follow the group's dense output,
// or rest.  Fixed and kinematic bodies follow their motion.  Everything here is a function of the
// arc's start and the time alone.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/placed-body.h"
#include "math/aabb.h"
#include "timeline/state.h"

namespace tw {

PoseTwist evaluate(const Body& body, const StateData& arc, double time);
// The pose alone: cheaper.
Frame frame_at(const Body& body, const StateData& arc, double time);
Vec3 center_at(const Body& body, const StateData& arc, double time);

// Where the arc ends by itself: at the next group check; `never` for isolated bodies.
double natural_end(const StateData& arc);
// The torque-free rotation of the arc (isolated dynamic bodies).
const FreeRotation& rotation_of(const Body& body, const StateData& arc);
// A bound on the angular speed over the whole arc (isolated bodies) or over [from, to] (others),
// rad/s.
double angular_speed_bound(const Body& body, const StateData& arc, double from, double to);

// A box around everything the body sweeps over [from, to]; bounded shapes only.
Aabb swept_bounds(const Body& body, const StateData& arc, double from, double to);

}  // namespace tw
