// The law of a contact (contact-law.h) at one point, as it is written there: a function of how the
// two bodies stand and move.
//
// The reference: steps of groups evaluate the same law four points at a time, with its derivatives
// (integrate/implicit/contact-pack.h), and are tested against this.  Whoever asks for one point
// asks here.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/contact-law.h"

namespace tw {

// World frame.
struct PointMotion {
  Vec3 normal = Vec3::UnitZ();   // n, unit, from a to b
  double depth = 0;              // d, m: the offset less the gap
  Vec3 velocity = Vec3::Zero();  // v_r, of b against a where the force acts, m/s
  Vec3 turning = Vec3::Zero();   // w_b - w_a, rad/s
  Vec3 stretch = Vec3::Zero();   // xi, m
  Vec3 bend = Vec3::Zero();      // beta, rad
};

// On b, world frame.
struct PointForce {
  double normal_force = 0;       // N >= 0
  Vec3 friction = Vec3::Zero();  // F, N
  Vec3 drag = Vec3::Zero();      // T, of the damper along the surfaces, N
  Vec3 torque = Vec3::Zero();    // M + Q, beside that of the force, N m
  Vec3 stretch_rate = Vec3::Zero(), bend_rate = Vec3::Zero();
  bool slips = false;  // friction is cut

  Vec3 force(const Vec3& normal) const { return normal_force * normal + friction + drag; }
};

// Of a point with the share `share` of the pair's springs.
PointForce point_force(const ContactConstants& law, double share, const PointMotion& at);
// Of the normal spring, and of the stretch and the bend as far as friction holds them, J.
double point_energy(const ContactConstants& law, double share, const PointMotion& at);

}  // namespace tw
