// One body of a pair at one instant: its constants and where it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/arc.h"
#include "kernel/body.h"

namespace tw {

struct Side {
  const Body* body = nullptr;
  ArcPoint point;
  Frame frame;

  Side(const Body& b, const ArcPoint& p) : body(&b), point(p), frame(p.q.toRotationMatrix(), p.x) {}
  Vec3 velocity_at(const Vec3& where) const { return point.v + point.w.cross(where - point.x); }
  // A bound on how fast any point of the surface moves now, m/s; a ball's rolls in its place.
  double surface_speed() const {
    const double turn = body->sphere_radius >= 0 ? 0 : point.w.norm() * body->radius;
    return point.v.norm() + (turn > 0 ? turn : 0);
  }
  // The same with what rolls in its place, as rest asks: a ball that spins does not rest.
  double fastest_point() const { return point.v.norm() + point.w.norm() * body->radius; }
};

}  // namespace tw
