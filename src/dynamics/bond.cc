// Springs and holds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/bond.h"

#include <cmath>

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

// Of a spring that hardens: h, sqrt(h), and df/dx for f = k h x + c sqrt(h) v.
struct Hardened {
  double h, root;

  Hardened(const SecondHardening& firm, const Vec3& x)
      : h(1 + (firm.firmness > 0 ? firm.hardness(x.norm()) : 0)), root(std::sqrt(h)) {}
  Mat3 by_x(double k, double c, const SecondHardening& firm, const Vec3& x, const Vec3& v) const {
    Mat3 result = (k * h) * Mat3::Identity();
    if (h == 1) return result;
    const double length = x.norm(), slope = firm.slope(length);
    return result + (k * slope * x + c * slope / (2 * root) * v) * x.transpose() / length;
  }
};

// Jl(phi)^-1, column by column.
Mat3 rate_matrix(const Vec3& phi) {
  Mat3 J;
  for (int i = 0; i < 3; ++i) J.col(i) = rotation_vector_rate(phi, Vec3::Unit(i));
  return J;
}

}  // namespace

Bond::Wrenches Bond::wrenches(const PoseTwist& on_a, const PoseTwist& on_b) const {
  const Reach reach(*this, on_a, on_b);
  const Vec3 f = spring.force(reach.d, reach.e, firm);
  Wrenches result;
  result.a = {f, reach.s_a.cross(f)};
  result.b = {-f, -reach.s_b.cross(f)};
  if (!holds) return result;
  const Vec3 phi = turned(turn, on_a, on_b);
  const Hardened hard(firm_turn, phi);
  const Vec3 torque = turn.stiffness * hard.h * phi + turn.damping * hard.root * (on_b.w - on_a.w);
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
  const Vec3 f = spring.force(reach.d, reach.e, firm);
  Mat3 by_d, by_e;
  spring.derivative(reach.d, reach.e, firm, by_d, by_e);
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
  const Hardened hard(firm_turn, phi);
  Mat3 by_turn[2] = {-turn.stiffness * rate_matrix(-phi), turn.stiffness * rate_matrix(phi)};
  if (hard.h > 1) {
    const Vec3 w = on_b.w - on_a.w;
    const Mat3 by_phi = hard.by_x(turn.stiffness, turn.damping, firm_turn, phi, w);
    by_turn[0] = -by_phi * rate_matrix(-phi);
    by_turn[1] = by_phi * rate_matrix(phi);
  }
  for (const int j : {0, 1}) {
    const double damping = turn.damping * hard.root;
    const Mat3 damped = (j == 0 ? -damping : damping) * Mat3::Identity();
    result.of[0][j].by_pose.bottomRightCorner<3, 3>() += by_turn[j];
    result.of[1][j].by_pose.bottomRightCorner<3, 3>() -= by_turn[j];
    result.of[0][j].by_twist.bottomRightCorner<3, 3>() += damped;
    result.of[1][j].by_twist.bottomRightCorner<3, 3>() -= damped;
  }
  return result;
}

double Bond::energy(const PoseTwist& on_a, const PoseTwist& on_b) const {
  const double stretched = spring.energy(Reach(*this, on_a, on_b).d, firm);
  if (!holds) return stretched;
  const Vec3 phi = turned(turn, on_a, on_b);
  return stretched + turn.stiffness * (0.5 * phi.squaredNorm() + firm_turn.energy(phi.norm()));
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

Vec3 SpringLaw::force(const Vec3& d, const Vec3& dv, const SecondHardening& firm) const {
  if (rest == 0) {
    const Hardened hard(firm, d);
    return stiffness * hard.h * d + damping * hard.root * dv;
  }
  const double l = d.norm();
  if (l == 0) return Vec3::Zero();
  const Vec3 u = d / l;
  return (stiffness * (l - rest) + damping * u.dot(dv)) * u;
}

// f = t u, t = k (l - rest) + c u.dv;  du = Q dd, Q = (1 - u u^T)/l;  dt = k u.dd + c dv.(Q dd) +
// c u.d(dv)
void SpringLaw::derivative(const Vec3& d, const Vec3& dv, const SecondHardening& firm, Mat3& by_d,
                           Mat3& by_dv) const {
  by_d.setZero();
  by_dv.setZero();
  if (rest == 0) {
    const Hardened hard(firm, d);
    by_d = hard.by_x(stiffness, damping, firm, d, dv);
    by_dv.diagonal().setConstant(damping * hard.root);
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

double SpringLaw::energy(const Vec3& d, const SecondHardening& firm) const {
  const double stretch = d.norm() - rest;
  return 0.5 * stiffness * stretch * stretch + stiffness * firm.energy(stretch);
}

}  // namespace tw
