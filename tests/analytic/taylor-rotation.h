// Torque-free rotation by Taylor series in 80-bit arithmetic: an independent reference.
//
// Symbols: P = R^T L (angular momentum in the body), w = I^-1 P.
//   P' = P x w,  q' = 1/2 q (0, w): quadratic, so the Taylor coefficients obey
//   (k+1) P_{k+1} = sum_i P_i x w_{k-i},  (k+1) q_{k+1} = 1/2 sum_i q_i (0, w_{k-i}).
// With 30 terms and steps of 2/5 over the sum of both largest rates the truncation is below 1e-19 a
// step.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"

namespace tw::reference {

using Real = long double;
using Vec3L = std::array<Real, 3>;
using Quat4L = std::array<Real, 4>;  // w x y z

inline Vec3L cross(const Vec3L& a, const Vec3L& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Quat4L product(const Quat4L& a, const Quat4L& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

inline Quat4L conjugate(const Quat4L& a) { return {a[0], -a[1], -a[2], -a[3]}; }

struct TaylorRotation {
  Vec3L moments{};
  Quat4L q{};
  Vec3L momentum_B{};

  TaylorRotation(const Vec3& I, const Quat& q_WB, const Vec3& L_W) {
    for (std::size_t i = 0; i < 3; ++i) moments[i] = I[static_cast<Eigen::Index>(i)];
    q = {q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z()};
    Real norm = 0;
    for (const Real x : q) norm += x * x;
    for (Real& x : q) x /= std::sqrt(norm);
    const Quat4L rotated = product(conjugate(q), product({0, L_W.x(), L_W.y(), L_W.z()}, q));
    momentum_B = {rotated[1], rotated[2], rotated[3]};
  }

  // Advances by `duration` seconds of either sign.
  void advance(Real duration) {
    // |w| <= sqrt(2E / I_min) turns the body; n follows with at most L / sqrt(I_min I_mid)
    Real twice_energy = 0;
    for (std::size_t i = 0; i < 3; ++i) twice_energy += momentum_B[i] * momentum_B[i] / moments[i];
    Vec3L sorted = moments;
    std::sort(sorted.begin(), sorted.end());
    const Real rate =
        std::sqrt(twice_energy / sorted[0]) +
        std::hypot(momentum_B[0], momentum_B[1], momentum_B[2]) / std::sqrt(sorted[0] * sorted[1]);
    const int steps = 1 + static_cast<int>(2.5L * rate * std::abs(duration));
    for (int i = 0; i < steps; ++i) step(duration / steps);
  }

  Vec3L angular_velocity_B() const {
    return {momentum_B[0] / moments[0], momentum_B[1] / moments[1], momentum_B[2] / moments[2]};
  }

  Quat attitude() const {
    return Quat(static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2]),
                static_cast<double>(q[3]));
  }

  // The angle between this attitude and another, rad.
  double angle_to(const Quat& other) const {
    const Quat4L d = product(conjugate(q), {other.w(), other.x(), other.y(), other.z()});
    return static_cast<double>(2 * std::atan2(std::hypot(d[1], d[2], d[3]), std::abs(d[0])));
  }

 private:
  static constexpr std::size_t order = 30;

  void step(Real h) {
    std::array<Vec3L, order + 1> P;
    std::array<Vec3L, order + 1> w;
    std::array<Quat4L, order + 1> a;
    P[0] = momentum_B;
    a[0] = q;
    for (std::size_t k = 0; k < order; ++k) {
      for (std::size_t i = 0; i < 3; ++i) w[k][i] = P[k][i] / moments[i];
      P[k + 1] = {};
      a[k + 1] = {};
      const Real n = static_cast<Real>(k + 1);
      for (std::size_t i = 0; i <= k; ++i) {
        const Vec3L& u = w[k - i];
        const Vec3L c = cross(P[i], u);
        const Quat4L d = product(a[i], {0, u[0], u[1], u[2]});
        for (std::size_t j = 0; j < 3; ++j) P[k + 1][j] += c[j] / n;
        for (std::size_t j = 0; j < 4; ++j) a[k + 1][j] += d[j] / (2 * n);
      }
    }
    momentum_B = P[order];
    q = a[order];
    for (std::size_t k = order; k-- > 0;) {
      for (std::size_t j = 0; j < 3; ++j) momentum_B[j] = P[k][j] + h * momentum_B[j];
      for (std::size_t j = 0; j < 4; ++j) q[j] = a[k][j] + h * q[j];
    }
  }
};

}  // namespace tw::reference
