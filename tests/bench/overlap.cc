// How deep boxes and balls overlap.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/overlap.h"

#include <algorithm>
#include <limits>

namespace tw::bench {

namespace {

// Of a box: sum of h_i |n . a_i|, half its width along n.
double half_width(const BoxOrBall& box, const Vec3& normal) {
  return box.half_edges.dot((box.frame.R.transpose() * normal).cwiseAbs());
}

double boxes(const BoxOrBall& a, const BoxOrBall& b) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (length < 1e-9) return;  // of edges that are parallel
    const Vec3 normal = direction / length;
    const double away = std::abs(normal.dot(a.frame.p - b.frame.p));
    least = std::min(least, half_width(a, normal) + half_width(b, normal) - away);
  };
  for (int i = 0; i < 3; ++i) {
    look(a.frame.R.col(i));
    look(b.frame.R.col(i));
    for (int j = 0; j < 3; ++j) look(a.frame.R.col(i).cross(b.frame.R.col(j)));
  }
  return std::max(least, 0.0);
}

double ball_in_box(const BoxOrBall& ball, const BoxOrBall& box) {
  const Vec3 x = box.frame.to_local(ball.frame.p);
  const Vec3 nearest = x.cwiseMax(-box.half_edges).cwiseMin(box.half_edges);
  const double outside = (x - nearest).norm();
  if (outside > 0) return std::max(ball.radius - outside, 0.0);
  return ball.radius + (box.half_edges - x.cwiseAbs()).minCoeff();
}

}  // namespace

double overlap(const BoxOrBall& a, const BoxOrBall& b) {
  const double away = (a.frame.p - b.frame.p).norm();
  if (away >= a.reach() + b.reach()) return 0;
  if (a.radius > 0 && b.radius > 0) return a.radius + b.radius - away;
  if (a.radius > 0) return ball_in_box(a, b);
  if (b.radius > 0) return ball_in_box(b, a);
  return boxes(a, b);
}

}  // namespace tw::bench
