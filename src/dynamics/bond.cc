// Springs and holds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/bond.h"

#include "base/hash.h"
#include "math/rotation-vector.h"

namespace tw {
namespace {

// The two points, and how the bodies move against each other at that of b.
struct Reach {
  Vec3 r_a, s_a, s_b;  // from the centre of a to its point and to that of b; of b to its own
  Vec3 d, e;

  Reach(const Bond& bond, const PoseTwist& a, const PoseTwist& b)
      : r_a(a.q * bond.arm_a),
        s_a(b.x + b.q * bond.arm_b - a.x),
        s_b(b.q * bond.arm_b),
        d(s_a - r_a),
        e(b.v + b.w.cross(s_b) - a.v - a.w.cross(s_a)) {}
};

// What b has turned beyond where a would have it, world frame.
Vec3 turned(const TurnLaw& law, const PoseTwist& a, const PoseTwist& b) {
  return turn_between(a.q * law.relative, b.q);
}

// Jl(phi)^-1, column by column.
Mat3 rate_matrix(const Vec3& phi) {
  Mat3 J;
  for (int i = 0; i < 3; ++i) J.col(i) = rotation_vector_rate(phi, Vec3::Unit(i));
  return J;
}

}  // namespace

Bond::Wrenches Bond::wrenches(const PoseTwist& on_a, const PoseTwist& on_b) const {
  const Reach reach(*this, on_a, on_b);
  const Vec3 f = spring.force(reach.d, reach.e);
  Wrenches result;
  result.a = {f, reach.s_a.cross(f)};
  result.b = {-f, -reach.s_b.cross(f)};
  if (!holds) return result;
  const Vec3 torque = turn.stiffness * turned(turn, on_a, on_b) + turn.damping * (on_b.w - on_a.w);
  result.a.torque += torque;
  result.b.torque -= torque;
  return result;
}

// With s_a, s_b from the centres to the point of b, r_a to that of a:
//   ds_b = -[s_b] dth_b,  ds_a = dx_b - dx_a + ds_b,  dd = ds_a + [r_a] dth_a,
//   de = dv_b - [s_b] dw_b + [w_b] ds_b - dv_a + [s_a] dw_a - [w_a] ds_a,
//   dT_a = [s_a] df - [f] ds_a,  dT_b = -[s_b] df + [f] ds_b;
// of the turn dphi = Jl(phi)^-1 dth_b - Jl(-phi)^-1 dth_a.
Bond::Derivative Bond::derivative(const PoseTwist& on_a, const PoseTwist& on_b) const {
  const Reach reach(*this, on_a, on_b);
  const Vec3 f = spring.force(reach.d, reach.e);
  Mat3 by_d, by_e;
  spring.derivative(reach.d, reach.e, by_d, by_e);
  const Mat3 F = cross_matrix(f), S_a = cross_matrix(reach.s_a), S_b = cross_matrix(reach.s_b);
  const Mat3 w_a = cross_matrix(on_a.w), w_b = cross_matrix(on_b.w);
  const Mat3 none = Mat3::Zero(), one = Mat3::Identity();

  // three columns, by what changes d, e, s_a and s_b so
  Derivative result;
  const auto put = [&](int j, Mat6 WrenchDerivative::*part, int column, const Mat3& dd,
                       const Mat3& de, const Mat3& ds_a, const Mat3& ds_b) {
    const Mat3 df = by_d * dd + by_e * de;
    Mat6 &of_a = result.of[0][j].*part, &of_b = result.of[1][j].*part;
    of_a.block<3, 3>(0, column) = df;
    of_a.block<3, 3>(3, column) = S_a * df - F * ds_a;
    of_b.block<3, 3>(0, column) = -df;
    of_b.block<3, 3>(3, column) = F * ds_b - S_b * df;
  };
  put(0, &WrenchDerivative::by_pose, 0, -one, w_a, -one, none);
  put(0, &WrenchDerivative::by_pose, 3, cross_matrix(reach.r_a), none, none, none);
  put(0, &WrenchDerivative::by_twist, 0, none, -one, none, none);
  put(0, &WrenchDerivative::by_twist, 3, none, S_a, none, none);
  put(1, &WrenchDerivative::by_pose, 0, one, -w_a, one, none);
  put(1, &WrenchDerivative::by_pose, 3, -S_b, (w_a - w_b) * S_b, -S_b, -S_b);
  put(1, &WrenchDerivative::by_twist, 0, none, one, none, none);
  put(1, &WrenchDerivative::by_twist, 3, none, -S_b, none, none);
  if (!holds) return result;
  const Vec3 phi = turned(turn, on_a, on_b);
  const Mat3 by_turn[2] = {-turn.stiffness * rate_matrix(-phi), turn.stiffness * rate_matrix(phi)};
  for (const int j : {0, 1}) {
    const Mat3 damped = (j == 0 ? -turn.damping : turn.damping) * Mat3::Identity();
    result.of[0][j].by_pose.bottomRightCorner<3, 3>() += by_turn[j];
    result.of[1][j].by_pose.bottomRightCorner<3, 3>() -= by_turn[j];
    result.of[0][j].by_twist.bottomRightCorner<3, 3>() += damped;
    result.of[1][j].by_twist.bottomRightCorner<3, 3>() -= damped;
  }
  return result;
}

double Bond::energy(const PoseTwist& on_a, const PoseTwist& on_b) const {
  const double stretched = spring.energy(Reach(*this, on_a, on_b).d);
  if (!holds) return stretched;
  return stretched + 0.5 * turn.stiffness * turned(turn, on_a, on_b).squaredNorm();
}

std::uint64_t Bond::hash() const {
  Hasher h;
  h.add(std::uint64_t{a});
  h.add(std::uint64_t{b});
  for (const double x : {spring.stiffness, spring.damping, spring.rest}) h.add(x);
  for (const Vec3* arm : {&arm_a, &arm_b})
    for (int i = 0; i < 3; ++i) h.add((*arm)[i]);
  if (!holds) return h.value();
  h.add(turn.stiffness);
  h.add(turn.damping);
  for (int i = 0; i < 4; ++i) h.add(turn.relative.coeffs()[i]);
  return h.value();
}

Vec3 SpringLaw::force(const Vec3& d, const Vec3& dv) const {
  if (rest == 0) return stiffness * d + damping * dv;
  const double l = d.norm();
  if (l == 0) return Vec3::Zero();
  const Vec3 u = d / l;
  return (stiffness * (l - rest) + damping * u.dot(dv)) * u;
}

// f = t u, t = k (l - rest) + c u.dv;  du = Q dd, Q = (1 - u u^T)/l;  dt = k u.dd + c dv.(Q dd) +
// c u.d(dv)
void SpringLaw::derivative(const Vec3& d, const Vec3& dv, Mat3& by_d, Mat3& by_dv) const {
  by_d.setZero();
  by_dv.setZero();
  if (rest == 0) {
    by_d.diagonal().setConstant(stiffness);
    by_dv.diagonal().setConstant(damping);
    return;
  }
  const double l = d.norm();
  if (l == 0) return;
  const Vec3 u = d / l;
  const double tension = stiffness * (l - rest) + damping * u.dot(dv);
  const Mat3 Q = (Mat3::Identity() - u * u.transpose()) / l;
  by_d = u * (stiffness * u + damping * (Q * dv)).transpose() + tension * Q;
  by_dv = damping * u * u.transpose();
}

double SpringLaw::energy(const Vec3& d) const {
  const double stretch = d.norm() - rest;
  return 0.5 * stiffness * stretch * stretch;
}

}  // namespace tw
