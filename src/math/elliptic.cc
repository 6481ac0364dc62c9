// Elliptic integrals: Carlson's R_F and Bulirsch's complete integral.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/elliptic.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"

namespace tw {
namespace {

// A bound on rounds: from the extremes of double's range both recurrences need under 600 and 20.
constexpr int max_rounds = 600;

// Quadratic convergence: a relative gap of 1e-8 now leaves 1e-16 in the mean.
constexpr double mean_gap = 1e-8;

}  // namespace

double carlson_rf(double x, double y, double z) {
  if (std::max({std::min(x, y), std::min(y, z), std::min(x, z)}) <= 0)
    return std::numeric_limits<double>::infinity();
  // the series below errs by O(spread^6) with a coefficient under 1/4: 3e-3^6 / 4 < 2e-16
  constexpr double spread = 2.5e-3;
  double mean = 0;
  double dx = 0;
  double dy = 0;
  double dz = 0;
  for (int round = 0; round < max_rounds; ++round) {
    mean = (x + y + z) / 3.0;
    dx = (mean - x) / mean;
    dy = (mean - y) / mean;
    dz = (mean - z) / mean;
    if (!(std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) > spread)) break;
    // duplication: R_F(x,y,z) = R_F((x+l)/4, (y+l)/4, (z+l)/4)
    const double sx = std::sqrt(x);
    const double sy = std::sqrt(y);
    const double sz = std::sqrt(z);
    const double l = sx * (sy + sz) + sy * sz;
    x = 0.25 * (x + l);
    y = 0.25 * (y + l);
    z = 0.25 * (z + l);
  }
  // Carlson (1995) eq. 1.3: elementary symmetric functions of the spreads
  const double e2 = dx * dy - dz * dz;
  const double e3 = dx * dy * dz;
  return (1.0 + (e2 / 24.0 - 0.1 - 3.0 * e3 / 44.0) * e2 + e3 / 14.0) / std::sqrt(mean);
}

double elliptic_cel(double kc, double p, double a, double b) {
  double e = kc;
  double m = 1.0;
  p = std::sqrt(p);
  b /= p;
  for (int round = 0; round < max_rounds; ++round) {
    // Bartky's transformation, Bulirsch (1969) section 4
    const double f = a;
    a += b / p;
    const double g = e / p;
    b += f * g;
    b += b;
    p += g;
    const double last = m;
    m += kc;
    if (!(std::abs(last - kc) > last * mean_gap)) break;
    kc = 2.0 * std::sqrt(e);
    e = kc * m;
  }
  return 0.5 * pi * (b + a * m) / (m * (m + p));
}

double elliptic_k(double kc) {
  if (kc == 0) return std::numeric_limits<double>::infinity();
  double a = 1.0;
  double g = kc;
  for (int round = 0; round < max_rounds; ++round) {
    if (!(std::abs(a - g) > a * mean_gap)) break;
    const double mean = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = mean;
  }
  return pi / (a + g);
}

}  // namespace tw
