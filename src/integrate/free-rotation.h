// Torque-free rotation of a rigid body in closed form.
//
// Frames: W world, B the body's principal frame (axes along the principal moments).
// Cases: at rest, spherical, axisymmetric, tri-axial (Jacobi elliptic functions and one integral
// of the third kind).  A function of the starting state and the elapsed time alone: random access,
// no step error, and the angular momentum L_W is a constant of the object.
//
// Symbols: n = R^T L / |L|, the unit direction of L in B; a, b, c the principal axes with b the
// middle moment and a the extreme axis about which n circulates (L^2 - 2E I_b has the sign of
// I_a - I_b), so n_a never changes sign, s = sign n_a.  Then (Landau & Lifshitz, Mechanics, 37)
//   n = (s A dn u, B sn u, C cn u),  u = lambda t + u0,
// and the attitude is Q * turn(phi(t)) * swing(n(t)): `swing` is the shortest rotation that takes
// n to s e_a, `turn` the rotation by phi about s e_a, and the constant Q takes s e_a to L / |L|.
//   phi' = (2E/L + s w_a) / (1 + s n_a),
// whose denominator is never below 1: no pole of the chart for any motion.  Its integral, of
// the third kind, is a mean rate and the argument of a theta function (free-rotation.cc).
// Cost (2 shared Xeon cores): 30 ns spherical, 60 axisymmetric, 75-100 tri-axial; construction
// 25, 70 and 350-480 ns.
// Source: C. G. J. Jacobi, Sur la rotation d'un corps, Crelle 39 (1850); Whittaker, Analytical
// Dynamics, 69-70.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "math/jacobi-theta.h"
#include "math/vec.h"

namespace tw {

class FreeRotation {
 public:
  FreeRotation() = default;
  // moments: principal moments I1, I2, I3, kg m^2, positive, any order.
  // q_WB: attitude at elapsed time 0, unit.  L_W: angular momentum, kg m^2/s, world.
  // L_W == 0: at rest.  A NaN anywhere gives a motion whose values are NaN.
  FreeRotation(const Vec3& moments, const Quat& q_WB, const Vec3& L_W);

  // Attitude (unit) and angular velocity (rad/s, world) after `elapsed` seconds (any sign).
  // The sign of the quaternion is continuous in time.
  void evaluate(double elapsed, Quat& q_WB, Vec3& w_W) const;
  // The attitude alone, where the velocity is not asked for.
  Quat attitude(double elapsed) const;
  // The least bound on |w(t)| for all t, rad/s (widened by rounding where |w| varies).
  double max_angular_speed() const { return max_angular_speed_; }
  // A bound on |w'(t)| for all t, rad/s^2; the least one but for triaxial bodies.
  double max_angular_acceleration() const { return max_angular_acceleration_; }

 private:
  // uniform: w is constant: a sphere, or spin about a principal axis.
  enum class Kind : unsigned char { rest, uniform, axisymmetric, triaxial };
  // Axes, amplitudes and invariants of the direction of L in the body.
  struct Orbit;

  void set_uniform(const Vec3& w_W);
  void set_axisymmetric(const Vec3& n, Eigen::Index a);
  void set_triaxial(const Vec3& n, double momentum, const Vec3& moments);
  void set_axes(Eigen::Index axis, double n_axis);
  void set_base(const Quat& q_WB);
  // turn(phi) swing(n), not normalised, and n, at an elapsed time.
  Quat local(double elapsed, Vec3& n) const;
  Quat local_axisymmetric(double elapsed, Vec3& n) const;
  Quat local_triaxial(double elapsed, Vec3& n) const;
  Quat turn_and_swing(double cos_half, double sin_half, const Vec3& n) const;

  Quat base_ = Quat::Identity();       // Q; the attitude itself where rest or uniform
  Vec3 speeds_ = Vec3::Zero();         // |L| / I_i: w_B = speeds * n; w_W where uniform
  Vec3 amplitudes_ = Vec3::Zero();     // (s A, B, C); n at time 0 where axisymmetric
  double half_turn_rate_ = 0;          // half the mean of phi'; |w|/2 where uniform
  double phase_ = 0, phase_rate_ = 0;  // x = pi u / (2K); body precession where axisymmetric
  double max_angular_speed_ = 0, max_angular_acceleration_ = 0;
  JacobiTheta theta_;
  Kind kind_ = Kind::rest;
  // a (circulation or symmetry), then j, k with (a, j, k) right-handed
  std::array<unsigned char, 3> axes_{0, 1, 2};
  bool middle_is_j_ = true;  // b = j, c = k; else b = k, c = j
  signed char side_ = 1;     // s
  signed char order_ = 1;    // +1 where I_a is the largest moment, -1 where the least
};

}  // namespace tw
