// One body at one instant: its constants, where it is and how fast.
//
// Frames: of the body's principal frame P at the centre of mass, in the world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "dynamics/body.h"
#include "dynamics/pose-twist.h"

namespace tw {

struct PlacedBody {
  const Body* body = nullptr;
  PoseTwist point;
  Frame frame;

  PlacedBody(const Body& b, const PoseTwist& p) : body(&b), point(p), frame(p.frame()) {}
  Vec3 velocity_at(const Vec3& where) const { return point.velocity_at(where); }
  // A bound on how fast any point of the surface moves against the centre, m/s: |w| radius, and of
  // what is slender about an axis as far as it turns otherwise than about that.
  double turning_speed() const {
    const double all = point.w.norm() * body->radius;
    if (body->slender_axis < 0) return all;
    const Vec3 axis = frame.R.col(body->slender_axis);
    const double along = axis.dot(point.w);
    return std::min(all,
                    (point.w - along * axis).norm() * body->radius + std::abs(along) * body->girth);
  }
  // A bound on how fast any point of the surface moves now, m/s; a ball's rolls in its place.
  double surface_speed() const {
    const double turn = body->sphere_radius >= 0 ? 0 : turning_speed();
    return point.v.norm() + (turn > 0 ? turn : 0);
  }
};

// What users see: the body frame's pose.
BodyState body_state(const Body& body, const PoseTwist& point);
// World inverse inertia R I^-1 R^T.
Mat3 inverse_inertia_world(const Body& body, const Quat& q);
Vec3 angular_momentum(const Body& body, const Quat& q, const Vec3& w);
double kinetic_energy(const Body& body, const PoseTwist& point);

}  // namespace tw
