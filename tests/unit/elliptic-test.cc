// Elliptic integrals against the standard library and classical identities.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/elliptic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/vec.h"

namespace tw {
namespace {

// The standard library forms 1 - k^2 itself: nearer to 1 its own digits go.
const double moduli[] = {0.0, 1e-8, 0.1, 0.5, 0.7, 0.9, 0.99};

double complement(double k) { return std::sqrt((1 - k) * (1 + k)); }

TEST(Elliptic, rf_gives_the_incomplete_first_integral) {
  for (const double k : moduli)
    for (double phi = 0.1; phi < 1.55; phi += 0.12) {
      const double s = std::sin(phi);
      const double c = std::cos(phi);
      const double f = s * carlson_rf(c * c, (1 - k * s) * (1 + k * s), 1.0);
      EXPECT_NEAR(f / std::ellint_1(k, phi), 1.0, 2e-15) << "k " << k << " phi " << phi;
    }
}

TEST(Elliptic, rf_is_symmetric_and_homogeneous) {
  const double f = carlson_rf(0.3, 1.7, 4.1);
  EXPECT_NEAR(carlson_rf(4.1, 0.3, 1.7), f, 2e-16);
  EXPECT_NEAR(carlson_rf(3e-9, 1.7e-8, 4.1e-8), f * 1e4, 4e-12);
  EXPECT_NEAR(carlson_rf(2.0, 2.0, 2.0), std::sqrt(0.5), 2e-16);
}

// R_F(x,y,y) = atan(sqrt((y-x)/x)) / sqrt(y-x)
TEST(Elliptic, rf_of_two_equal_arguments_is_an_arc_tangent) {
  for (const double x : {1e-200, 1e-30, 1e-3, 0.4, 0.999}) {
    const double exact = std::atan(std::sqrt((1 - x) / x)) / std::sqrt(1 - x);
    EXPECT_NEAR(carlson_rf(x, 1.0, 1.0) / exact, 1.0, 1e-15) << x;
  }
}

TEST(Elliptic, rf_diverges_at_two_zeros) {
  EXPECT_EQ(carlson_rf(0, 0, 1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(carlson_rf(0, 1, 0), std::numeric_limits<double>::infinity());
}

TEST(Elliptic, k_agrees_with_the_standard_library) {
  for (const double k : moduli)
    EXPECT_NEAR(elliptic_k(complement(k)) / std::comp_ellint_1(k), 1.0, 1e-14) << k;
}

// K -> ln(4/kc)
TEST(Elliptic, k_is_logarithmic_near_modulus_one) {
  for (const double kc : {1e-10, 1e-60, 1e-120})
    EXPECT_NEAR(elliptic_k(kc) / std::log(4.0 / kc), 1.0, 1e-15) << kc;
  EXPECT_EQ(elliptic_k(0), std::numeric_limits<double>::infinity());
}

// The library's K - n/3 R_J cancels for large -n: its error, not ours, is in the bound.
TEST(Elliptic, cel_gives_the_complete_third_integral) {
  for (const double k : moduli)
    for (const double n : {-1e6, -30.0, -1.0, -1e-3, 0.0, 0.5}) {
      const double exact = std::comp_ellint_3(k, n);
      EXPECT_NEAR(elliptic_cel(complement(k), 1 - n, 1, 1) / exact, 1.0, 1e-14 - 2e-18 * n)
          << "k " << k << " n " << n;
    }
}

// m = 0: int (a cos^2 + b sin^2) / (cos^2 + p sin^2) = pi/2 (a + b/sqrt p) / (1 + sqrt p)
TEST(Elliptic, cel_of_modulus_zero_is_elementary) {
  for (const double p : {1e-12, 0.3, 1.0, 7.0, 1e12}) {
    const double r = std::sqrt(p);
    EXPECT_NEAR(elliptic_cel(1, p, 2, 5) / (0.5 * pi * (2 + 5 / r) / (1 + r)), 1.0, 1e-15) << p;
  }
}

// E K' + E' K - K K' = pi/2
TEST(Elliptic, legendre_relation_holds) {
  for (const double k : {1e-4, 0.1, 0.5, 0.7, 0.9, 0.99}) {
    const double kc = complement(k);
    const double K = elliptic_cel(kc, 1, 1, 1);
    const double E = elliptic_cel(kc, 1, 1, kc * kc);
    const double Kp = elliptic_cel(k, 1, 1, 1);
    const double Ep = elliptic_cel(k, 1, 1, k * k);
    EXPECT_NEAR(E * Kp + (Ep - Kp) * K, 0.5 * pi, 1e-14) << k;
    EXPECT_NEAR(K, elliptic_k(kc), 1e-15 * K);
  }
}

}  // namespace
}  // namespace tw
