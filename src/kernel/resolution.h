// Impulses on bodies: the velocities of a discontinuity while they change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/impact-law.h"
#include "timeline/arc.h"
#include "timeline/successor.h"

namespace tw {

// One body during the resolution of an impact.
struct Resolved {
  const Body& body;
  const PoseTwist& point;
  Vec3 v, w;
  Mat3 inverse_inertia = Mat3::Zero();
  double inverse_mass = 0;
  bool moves;

  Resolved(const Body& b, const PoseTwist& p)
      : body(b), point(p), v(p.v), w(p.w), moves(b.dynamic()) {
    if (!moves) return;
    inverse_mass = 1 / b.mass;
    inverse_inertia = inverse_inertia_world(b, p.q);
  }
  // As if it had no end of mass.
  void hold() {
    moves = false;
    inverse_mass = 0;
    inverse_inertia.setZero();
  }
  Vec3 velocity_at(const Vec3& where) const { return v + w.cross(where - point.x); }
  Mat3 compliance(const Vec3& where) const {
    if (!moves) return Mat3::Zero();
    return contact_compliance(inverse_mass, inverse_inertia, where - point.x);
  }
  void apply(const Vec3& impulse, const Vec3& where) {
    if (!moves) return;
    v += inverse_mass * impulse;
    w += inverse_inertia * (where - point.x).cross(impulse);
  }
};

// The draft's motion is now what impulses made of it.
inline void take_velocities(Successor& successor, const Resolved& after) {
  successor.data.v = successor.point.v = after.v;
  successor.point.w = after.w;
  successor.data.L = angular_momentum(*successor.body, successor.point.q, after.w);
}

}  // namespace tw
