// What the limits of an axis hold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/limits.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "math/rotation-vector.h"

namespace tw::multibody {
LimitedAngle limited_angle(const Axis& axis, const Quat& q) {
  LimitedAngle result;
  Vec3 direction;
  Mat3 change;
  if (axis.swinging.isZero(0)) {
    const double side = q.w() < 0 ? -1 : 1, w = side * q.w();
    direction = side * q.vec();
    result.angle = 2 * std::atan2(direction.norm(), w);
    change = 0.5 * (w * Mat3::Identity() + cross_matrix(direction));
  } else {
    const Vec3 &a = axis.swinging, p = q.conjugate() * a;
    direction = p.cross(a);
    result.angle = std::atan2(direction.norm(), a.dot(p));
    change = a.dot(p) * Mat3::Identity() - p * a.transpose();
  }
  const double length = direction.norm();
  if (length == 0) return result;
  const Vec3& n = result.direction = direction / length;
  result.direction_by_turn = (Mat3::Identity() - n * n.transpose()) * change / length;
  return result;
}

double limited(const Axis& axis, In q) {
  return axis.ball ? limited_angle(axis, quaternion_at(&q[index(axis.q)])).angle : q[index(axis.q)];
}

double limited_rate(const Axis& axis, In q, In u) {
  if (!axis.ball) return u[index(axis.u)];
  const Vec3 n = limited_angle(axis, quaternion_at(&q[index(axis.q)])).direction;
  return n.dot(vector_at(&u[index(axis.u)]));
}

void set_along_limited(const Axis& axis, In q, double magnitude, Out force) {
  std::fill(force.begin(), force.end(), 0.0);
  if (axis.ball) {
    const Vec3 n = limited_angle(axis, quaternion_at(&q[index(axis.q)])).direction;
    set_vector(&force[index(axis.u)], magnitude * n);
  } else {
    force[index(axis.u)] = magnitude;
  }
}

Quat within_limit(const Axis& axis, const Quat& q) {
  const LimitedAngle now = limited_angle(axis, q);
  if (!(now.angle > axis.law.upper)) return q;
  // back about n, by what is too much and its rounding
  constexpr double rounding = 1e-15;
  const double back = now.angle - axis.law.upper * (1 - rounding) + rounding;
  return (q * short_rotation(-back * now.direction)).normalized();
}

}  // namespace tw::multibody
