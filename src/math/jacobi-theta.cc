// Jacobi's sn, cn, dn and one shifted theta function, by theta series whose nome is at most e^-pi.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/jacobi-theta.h"

#include <cmath>

#include "math/elliptic.h"
#include "math/vec.h"

namespace tw {
namespace {

// pi - (the double pi)
constexpr double pi_low = 1.2246467991473532e-16;

struct ThetaConstants {
  double theta2, theta3, theta4;  // at 0; theta2 without its factor 2 q^(1/4)
};

// theta_3,4(0) = 1 +- 2q + 2q^4 +- 2q^9, theta_2(0) = 2 q^(1/4) (1 + q^2 + q^6 + q^12)
ThetaConstants theta_constants(double q) {
  const double q2 = q * q;
  const double q4 = q2 * q2;
  const double odd = 2.0 * q * (1.0 + q4 * q4);
  const double even = 1.0 + 2.0 * q4;
  return {1.0 + q2 * (1.0 + q4 * (1.0 + q2 * q4)), even + odd, even - odd};
}

}  // namespace

JacobiTheta::JacobiTheta(double m, double m1, double alpha) : hyperbolic_(m > 0.5) {
  k_ = elliptic_k(std::sqrt(m1));
  const double k_prime = elliptic_k(std::sqrt(m));
  if (hyperbolic_)
    set_hyperbolic(alpha, k_prime);
  else
    set_trigonometric(alpha, k_prime);
}

void JacobiTheta::set_trigonometric(double alpha, double k_prime) {
  nome_ = std::exp(-pi * k_prime / k_);
  const ThetaConstants t = theta_constants(nome_);
  // cn(0) = dn(0) = 1 and sn(K) = 1, where theta_4 is theta_4(0) and theta_3(0)
  sn_ = t.theta3 / t.theta2;
  cn_ = t.theta4 / t.theta2;
  dn_ = t.theta4 / t.theta3;
  // with k = 2n+1, h = e^-2y, d = q/h = e^{-2 (y' - y)}, over 2 q^(1/4) e^y / 2:
  //   i theta_1(x - i y) = sum (-1)^n q^(n^2) d^n [(1 - h^k) cos kx + i (1 + h^k) sin kx]
  const double y2 = pi * alpha / k_;
  const double d = std::isfinite(k_prime) ? std::exp(-pi * (k_prime - alpha) / k_) : 0.0;
  double power = 1.0;     // (-1)^n q^(n^2) d^n
  double ratio = -nome_;  // q^(2n+1), with the sign
  for (std::size_t n = 0; n < terms; ++n) {
    const double minus = -std::expm1(-static_cast<double>(2 * n + 1) * y2);
    shift_re_[n] = power * minus;
    shift_im_[n] = power * (2.0 - minus);
    power *= ratio * d;
    ratio *= nome_ * nome_;
  }
}

void JacobiTheta::set_hyperbolic(double alpha, double k_prime) {
  nome_ = std::exp(-pi * k_ / k_prime);
  stretch_ = k_ / k_prime;
  turn_ = alpha / k_prime;
  const ThetaConstants t = theta_constants(nome_);
  // Jacobi: sn(u|m) = -i sc(iu|m1), cn(u|m) = nc(iu|m1), dn(u|m) = dc(iu|m1)
  sn_ = t.theta3 / t.theta4;
  cn_ = t.theta2 / t.theta4;
  dn_ = t.theta2 / t.theta3;
  // theta_1(Y + iX|q') = sum (-1)^n q'^(n(n+1)) [sin kY cosh kX + i cos kY sinh kX]
  const double y = 0.5 * pi * turn_;
  double power = 1.0;  // (-1)^n q'^(n^2); the factor q'^n goes with the hyperbolic functions
  double ratio = -nome_;
  for (std::size_t n = 0; n < terms; ++n) {
    const double k = static_cast<double>(2 * n + 1);
    shift_re_[n] = power * std::sin(k * y);
    shift_im_[n] = power * std::cos(k * y);
    power *= ratio;
    ratio *= nome_ * nome_;
  }
}

JacobiTheta::Values JacobiTheta::trigonometric(double x) const {
  const double s1 = std::sin(x);
  const double c1 = std::cos(x);
  const double c2 = (c1 - s1) * (c1 + s1);
  const double s2 = 2.0 * s1 * c1;
  // multiples of x by rotation through 2x
  const double c3 = c1 * c2 - s1 * s2, s3 = s1 * c2 + c1 * s2;
  const double c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2;
  const double c7 = c5 * c2 - s5 * s2, s7 = s5 * c2 + c5 * s2;
  const double c4 = 2.0 * c2 * c2 - 1.0;
  const double c6 = c2 * (2.0 * c4 - 1.0);
  const double q = nome_;
  const double q2 = q * q;
  const double q3 = q * q2;
  const double q4 = q2 * q2;
  Values v;
  // theta_1 / 2q^(1/4) = sin x - q^2 sin 3x + q^6 sin 5x, theta_2 likewise with cosines
  v.sn = sn_ * (s1 - q2 * (s3 - q4 * s5));
  v.cn = cn_ * (c1 + q2 * (c3 + q4 * c5));
  // theta_3 = 1 + 2q cos 2x + 2q^4 cos 4x + 2q^9 cos 6x
  v.dn = dn_ * (1.0 + 2.0 * q * (c2 + q3 * (c4 + q4 * q * c6)));
  v.re = shift_re_[0] * c1 + (shift_re_[1] * c3 + (shift_re_[2] * c5 + shift_re_[3] * c7));
  v.im = shift_im_[0] * s1 + (shift_im_[1] * s3 + (shift_im_[2] * s5 + shift_im_[3] * s7));
  v.turn = 0;
  return v;
}

JacobiTheta::Values JacobiTheta::hyperbolic(double x) const {
  // u -> u - 2jK keeps dn and flips sn, cn, theta_1 for odd j
  const double j = std::nearbyint(x / pi);
  // beyond 2^50 half turns the phase has no digits left, but it must stay in range
  const double reduced =
      std::abs(j) < 1e15 ? std::fma(-j, pi_low, std::fma(-j, pi, x)) : std::remainder(x, pi);
  const double flip = std::fmod(j, 2.0) == 0 ? 1.0 : -1.0;
  // everything over e^|X|: f = e^-|X|, h = q' e^2|X| <= 1, g = q' e^-2|X|
  const double big_x = stretch_ * std::abs(reduced);
  const double side = std::copysign(1.0, reduced);
  const double f = std::exp(-big_x);
  const double f2 = f * f;
  const double minus = big_x < 0.5 ? -std::expm1(-2.0 * big_x) : 1.0 - f2;
  const double q = nome_;
  const double h = q / f2;
  const double g = q * f2;
  const double h2 = h * h, h3 = h * h2;
  const double g2 = g * g, g3 = g * g2;
  const double q2 = q * q;
  const double q4 = q2 * q2;
  // 2 cosh kX and 2 sinh kX times q'^n, k = 2n+1
  const double ch1 = h + f2 * g, sh1 = h - f2 * g;
  const double ch2 = h2 + f2 * g2, sh2 = h2 - f2 * g2;
  const double ch3 = h3 + f2 * g3, sh3 = h3 - f2 * g3;
  Values v;
  // theta_1(iX) ~ sum (-1)^n q'^(n(n+1)) sinh kX
  v.sn = side * sn_ * (minus - q * (sh1 - q2 * q * (sh2 - q4 * q * sh3)));
  // theta_4,3(iX) = 1 -+ 2q' cosh 2X + 2q'^4 cosh 4X -+ 2q'^9 cosh 6X
  const double even = 1.0 + q2 * (h2 + g2);
  const double odd = h + g + q2 * q4 * (h3 + g3);
  v.cn = cn_ * 2.0 * f * (even - odd);
  v.dn = dn_ * 2.0 * f * (even + odd);
  v.re =
      shift_re_[0] * (1.0 + f2) + (shift_re_[1] * ch1 + (shift_re_[2] * ch2 + shift_re_[3] * ch3));
  v.im = side *
         (shift_im_[0] * minus + (shift_im_[1] * sh1 + (shift_im_[2] * sh2 + shift_im_[3] * sh3)));
  // the half turns
  v.sn *= flip;
  v.cn *= flip;
  v.re *= flip;
  v.im *= flip;
  v.turn = turn_ * reduced;
  return v;
}

}  // namespace tw
