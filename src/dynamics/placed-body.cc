// What follows from a body's pose and twist.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/placed-body.h"

namespace tw {

BodyState body_state(const Body& body, const PoseTwist& point) {
  BodyState state;
  state.orientation = point.q * body.X_PB.q;
  state.position = point.x + point.q * body.X_PB.p;
  state.velocity = point.v;
  state.angular_velocity = point.w;
  return state;
}

Mat3 inverse_inertia_world(const Body& body, const Quat& q) {
  const Mat3 R = q.toRotationMatrix();
  return R * body.moments.cwiseInverse().asDiagonal() * R.transpose();
}

Vec3 angular_momentum(const Body& body, const Quat& q, const Vec3& w) {
  const Vec3 w_P = q.conjugate() * w;
  return q * Vec3(body.moments.cwiseProduct(w_P));
}

double kinetic_energy(const Body& body, const PoseTwist& point) {
  const Vec3 w_P = point.q.conjugate() * point.w;
  return 0.5 * (body.mass * point.v.squaredNorm() + w_P.dot(body.moments.cwiseProduct(w_P)));
}

}  // namespace tw
