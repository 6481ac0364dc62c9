// The left Jacobian of the rotation group and its inverse.
//
// Near 0 by series: the closed forms cancel.  Below phi = 1/2 the omitted terms are under 1e-15.
//
// Source: J. Sola, J. Deray, D. Atchuthan, A micro Lie theory for state estimation in robotics
// (2018), B.2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/rotation-vector.h"

#include <cmath>
#include <utility>

namespace tw {

namespace {

// phi^2 below which the series serve
constexpr double near = 0.25;

// value of a polynomial, lowest coefficient first
template <int n>
double polynomial(const double (&c)[n], double x) {
  double value = c[n - 1];
  for (int i = n - 2; i >= 0; --i) value = value * x + c[i];
  return value;
}

// (1 - (phi/2) cot(phi/2))/phi^2
double inverse_jacobian_term(double squared) {
  // Bernoulli numbers |B_2k|/(2k)!
  constexpr double series[] = {1.0 / 12,      1.0 / 720,      1.0 / 30240,
                               1.0 / 1209600, 1.0 / 47900160, 691.0 / 1307674368000};
  if (squared < near) return polynomial(series, squared);
  const double half = 0.5 * std::sqrt(squared);
  return (1 - half * std::cos(half) / std::sin(half)) / squared;
}

// The factors of the left Jacobian,
//   p = sum (-1)^k phi^2k/(2k+2)!,  q = sum (-1)^k phi^2k/(2k+3)!
struct Jacobian {
  double p, q;

  explicit Jacobian(double squared) {
    constexpr double p_series[] = {1.0 / 2,      -1.0 / 24,     1.0 / 720,
                                   -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600};
    constexpr double q_series[] = {1.0 / 6,       -1.0 / 120,     1.0 / 5040,
                                   -1.0 / 362880, 1.0 / 39916800, -1.0 / 6227020800};
    const double phi = std::sqrt(squared);
    const bool series = squared < near;
    p = series ? polynomial(p_series, squared) : (1 - std::cos(phi)) / squared;
    q = series ? polynomial(q_series, squared) : (phi - std::sin(phi)) / (squared * phi);
  }
  // By phi^2.
  std::pair<double, double> slopes(double squared) const {
    constexpr double p_series[] = {-1.0 / 24,     2.0 / 720,        -3.0 / 40320,
                                   4.0 / 3628800, -5.0 / 479001600, 6.0 / 87178291200};
    constexpr double q_series[] = {-1.0 / 120,     2.0 / 5040,        -3.0 / 362880,
                                   4.0 / 39916800, -5.0 / 6227020800, 6.0 / 1307674368000};
    if (squared < near) return {polynomial(p_series, squared), polynomial(q_series, squared)};
    const double phi = std::sqrt(squared);
    return {(0.5 * std::sin(phi) / phi - p) / squared, (0.5 * p - 1.5 * q) / squared};
  }
};

}  // namespace

Vec3 rotation_vector_rate(const Vec3& theta, const Vec3& w) {
  const Vec3 turned = theta.cross(w);
  return w - 0.5 * turned + inverse_jacobian_term(theta.squaredNorm()) * theta.cross(turned);
}

Vec3 angular_velocity(const Vec3& theta, const Vec3& rate) {
  const Jacobian by(theta.squaredNorm());
  const Vec3 turned = theta.cross(rate);
  return rate + by.p * turned + by.q * theta.cross(turned);
}

// The rate of each of the three terms; p' = 2 (theta.theta') dp/d(phi^2).
Vec3 angular_acceleration(const Vec3& theta, const Vec3& rate, const Vec3& change) {
  const double squared = theta.squaredNorm();
  const Jacobian by(squared);
  const auto [p_slope, q_slope] = by.slopes(squared);
  const double growth = 2 * theta.dot(rate);
  const Vec3 turned = theta.cross(rate), turned_rate = theta.cross(change);
  return change + growth * p_slope * turned + by.p * turned_rate +
         growth * q_slope * theta.cross(turned) +
         by.q * (rate.cross(turned) + theta.cross(turned_rate));
}

Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat d = to * from.conjugate();
  if (d.w() < 0) d.coeffs() = -d.coeffs();
  const double s = d.vec().norm();
  if (s == 0) return Vec3::Zero();
  return (2 * std::atan2(s, d.w()) / s) * d.vec();
}

Quat short_rotation(const Vec3& theta) {
  // sin(phi/2)/phi and cos(phi/2) in y = (phi/2)^2, exact to rounding up to phi = 0.2
  constexpr double sine[] = {0.5, -0.5 / 6, 0.5 / 120, -0.5 / 5040, 0.5 / 362880};
  constexpr double cosine[] = {1, -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800};
  const double y = 0.25 * theta.squaredNorm();
  if (!(y < 0.01)) return rotation_by(theta);
  const double s = polynomial(sine, y);
  return Quat(polynomial(cosine, y), s * theta.x(), s * theta.y(), s * theta.z());
}

}  // namespace tw
