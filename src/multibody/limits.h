// What the limits of an axis hold: its coordinate; of a spherical joint one angle.
//
// That is the angle by which the joint has turned from 0, or, where an axis a is given, the angle
// by which a has swung, whatever turns about it.  With n the direction of turning by which it grows
// fastest, in the link's frame, theta' = n.u:
//   turned  q = (w, v), w >= 0:        theta = 2 atan2(|v|, w),     n = v/|v|
//   swung   p = R^T a, m = p x a:      theta = atan2(|m|, a.p),     n = m/|m|
// By a turn z in the link's frame dv = (w z + v x z)/2, dp = p x z, so that
//   dn = (1 - n n^T) dv/|v|   and   dn = (1 - n n^T) ((p.a) 1 - p a^T) z/|m|.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/coordinates.h"

namespace tw::multibody {

// Of a spherical joint; the direction is 0 where the angle is 0 or pi.
struct LimitedAngle {
  double angle = 0;  // rad, 0 to pi
  Vec3 direction = Vec3::Zero();
  Mat3 direction_by_turn = Mat3::Zero();
};
LimitedAngle limited_angle(const Axis& axis, const Quat& q);

// Of positions q (nq) and velocities u (nv): what is limited, rad or m, and its rate.
double limited(const Axis& axis, In q);
double limited_rate(const Axis& axis, In q, In u);
// The generalised force, or impulse, nv numbers, of `magnitude` along it.
void set_along_limited(const Axis& axis, In q, double magnitude, Out force);

// What is nearest to q within the limit of a spherical joint.
Quat within_limit(const Axis& axis, const Quat& q);

}  // namespace tw::multibody
