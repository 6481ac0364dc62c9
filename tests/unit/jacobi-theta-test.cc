// Jacobi's functions by theta series: identities, inversion and the extremes of the modulus.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/jacobi-theta.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/elliptic.h"
#include "math/vec.h"

namespace tw {
namespace {

struct Modulus {
  double m, m1;
};

// both sides of the change of series at 1/2, and the extremes
const Modulus all_moduli[] = {
    {0, 1},       {1e-200, 1},      {1e-16, 1},         {0.01, 0.99}, {0.5, 0.5}, {0.501, 0.499},
    {0.99, 0.01}, {1 - 1e-9, 1e-9}, {1 - 1e-16, 1e-16}, {1, 1e-40},   {1, 1e-240}};

// A shift a third of the way to K'.
JacobiTheta make(const Modulus& k) {
  return JacobiTheta(k.m, k.m1, elliptic_k(std::sqrt(k.m)) / 3.0);
}

TEST(JacobiTheta, squares_obey_the_identities_for_every_modulus) {
  for (const Modulus& k : all_moduli) {
    const JacobiTheta theta = make(k);
    for (double x = -7; x < 7; x += 0.0917) {
      const JacobiTheta::Values v = theta.at(x);
      // dn^2 = cn^2 + m1 sn^2, free of cancellation
      const double sum = v.cn * v.cn + k.m1 * v.sn * v.sn;
      EXPECT_NEAR(std::sqrt(sum) / v.dn, 1.0, 1e-14) << "m1 " << k.m1 << " x " << x;
      EXPECT_GT(v.dn, 0);
    }
  }
}

TEST(JacobiTheta, the_argument_is_the_elliptic_integral_of_the_amplitude) {
  for (const Modulus& k : all_moduli) {
    const JacobiTheta theta = make(k);
    for (double x = 0.02; x < 1.57; x += 0.031) {
      const JacobiTheta::Values v = theta.at(x);
      const double sum = v.cn * v.cn + v.sn * v.sn;
      const double u = v.sn * carlson_rf(v.cn * v.cn, v.dn * v.dn, sum);
      EXPECT_NEAR(u * 0.5 * pi / theta.quarter_period() / x, 1.0, 3e-15)
          << "m1 " << k.m1 << " x " << x;
    }
  }
}

TEST(JacobiTheta, functions_repeat_after_four_quarter_periods) {
  for (const Modulus& k : all_moduli) {
    const JacobiTheta theta = make(k);
    for (const double x : {0.3, 1.2, 1.6, 2.9}) {
      const JacobiTheta::Values v = theta.at(x);
      const JacobiTheta::Values half = theta.at(x - pi);
      const JacobiTheta::Values far = theta.at(x + 2000 * pi);
      const double size = std::hypot(v.sn, v.cn);
      // the argument's own rounding, magnified by K/K' = d ln / dx
      const double error = 1e-12 * size * (1 + theta.quarter_period());
      EXPECT_NEAR(half.sn, -v.sn, error);
      EXPECT_NEAR(half.cn, -v.cn, error);
      EXPECT_NEAR(half.dn, v.dn, error);
      EXPECT_NEAR(far.sn, v.sn, error);
      EXPECT_NEAR(far.cn, v.cn, error);
      EXPECT_NEAR(far.dn, v.dn, error);
    }
  }
}

// |theta_1(x - iy)|^2 : theta_4(x)^2 is as sn^2 u + sc^2(alpha|m1), for theta_1(x-iy) theta_1(x+iy)
// theta_4(0)^2 = theta_1(x)^2 theta_4(iy)^2 - theta_4(x)^2 theta_1(iy)^2.
TEST(JacobiTheta, the_shifted_function_has_its_zero_at_the_shift) {
  const Modulus moduli[] = {{1e-3, 0.999}, {0.3, 0.7}, {0.5, 0.5}, {0.52, 0.48}, {0.999, 1e-3}};
  for (const Modulus& k : moduli)
    for (const double part : {1e-4, 0.2, 0.7, 0.999}) {
      const double alpha = part * elliptic_k(std::sqrt(k.m));
      const JacobiTheta theta(k.m, k.m1, alpha);
      // sc(alpha|m1) from the functions of the complementary modulus
      const JacobiTheta other(k.m1, k.m, 1.0);
      const JacobiTheta::Values o = other.at(0.5 * pi * part);
      const double sc2 = o.sn * o.sn / (o.cn * o.cn);
      double first = 0;
      for (double x = 0.01; x < 3.2; x += 0.1) {
        const JacobiTheta::Values v = theta.at(x);
        const double norm = v.sn * v.sn + v.cn * v.cn;
        const double ratio = (v.re * v.re + v.im * v.im) / (v.sn * v.sn + sc2 * norm);
        if (first == 0) first = ratio;
        EXPECT_NEAR(ratio / first, 1.0, 1e-12) << "m " << k.m << " part " << part << " x " << x;
      }
    }
}

// arg[i theta_1(x - iy)] by the two series: the same angle on both sides of m = 1/2.
TEST(JacobiTheta, the_two_series_agree_at_one_half) {
  const double alpha = 0.6 * elliptic_k(std::sqrt(0.5));
  const JacobiTheta low(0.5, 0.5, alpha);
  const JacobiTheta high(0.5 + 1e-15, 0.5 - 1e-15, alpha);
  for (double x = -3; x < 3; x += 0.1) {
    const JacobiTheta::Values a = low.at(x);
    const JacobiTheta::Values b = high.at(x);
    const double angle = std::atan2(a.im, a.re) - std::atan2(b.im, b.re) - b.turn;
    EXPECT_NEAR(std::remainder(angle, 2 * pi), 0.0, 2e-14) << x;
    EXPECT_NEAR(std::atan2(a.sn, a.cn), std::atan2(b.sn, b.cn), 2e-14) << x;
  }
}

TEST(JacobiTheta, modulus_zero_gives_circular_functions) {
  const JacobiTheta theta(0, 1, INFINITY);
  for (double x = -3; x < 3; x += 0.1) {
    const JacobiTheta::Values v = theta.at(x);
    EXPECT_NEAR(v.sn, std::sin(x), 1e-15);
    EXPECT_NEAR(v.cn, std::cos(x), 1e-15);
    EXPECT_EQ(v.dn, 1.0);
    EXPECT_NEAR(std::atan2(v.im, v.re), x, 1e-15);
  }
}

}  // namespace
}  // namespace tw
