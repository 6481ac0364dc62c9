// How the two bodies of a piece stand to each other at one instant.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/approach.h"

#include <cmath>

#include "base/constants.h"
#include "dynamics/placed-body.h"

namespace tw {
namespace {

// A bound on how fast any point of the body moves, m/s.
double point_speed(const Body& body, const PoseTwist& p) {
  const double turn = p.w.norm();
  return p.v.norm() + (turn > 0 ? turn * body.radius : 0);
}

}  // namespace

Separation separation_at(const Piece& piece, double when) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  return separation(*a.shape_P, piece.a->trajectory().frame(when), *b.shape_P,
                    piece.b->trajectory().frame(when));
}

double distance_at(const Piece& piece, double when) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  return signed_distance(*a.shape_P, piece.a->trajectory().frame(when), *b.shape_P,
                         piece.b->trajectory().frame(when));
}

double closing_at(const Piece& piece, double when, const Separation& s) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  const PoseTwist pa = piece.a->trajectory().at(when), pb = piece.b->trajectory().at(when);
  const Vec3 ua = pa.v + pa.w.cross(s.point_a - pa.x), ub = pb.v + pb.w.cross(s.point_b - pb.x);
  const double closing = -(ub - ua).dot(s.normal);
  return std::abs(closing) > answer::speed_noise * (point_speed(a, pa) + point_speed(b, pb))
             ? closing
             : 0;
}

bool pressed_at(const Piece& piece, double when, const Vec3& normal) {
  const Vec3 pull_a = piece.a->trajectory().free_acceleration(when);
  const Vec3 pull_b = piece.b->trajectory().free_acceleration(when);
  return (pull_b - pull_a).dot(normal) < 0;
}

}  // namespace tw
