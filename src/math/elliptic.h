// Elliptic integrals: Carlson's R_F and Bulirsch's complete integral.
//
// Conventions: the parameter m = k^2 and its complement m1 = 1 - m.  Only m1 is asked for where
// small m1 matters, so that a modulus near 1 keeps all its digits.
// Cost: both converge quadratically or better; 6 to 12 rounds.
// Source: B. C. Carlson, Numerical Algorithms 10 (1995) 13-26; R. Bulirsch, Numerische Mathematik
// 13 (1969) 305-315.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Carlson's symmetric integral R_F(x,y,z) = 1/2 int_0^inf dt / sqrt((t+x)(t+y)(t+z)).
// x, y, z >= 0, at most one of them zero (two zeros, or a NaN, give infinity or NaN).
double carlson_rf(double x, double y, double z);

// Bulirsch's complete integral
//   cel(kc,p,a,b) = int_0^{pi/2} (a cos^2 + b sin^2) / (cos^2 + p sin^2)
//                                / sqrt(cos^2 + kc^2 sin^2).
// kc > 0, p > 0; for a, b >= 0 every operation adds positive numbers: no cancellation.
// K = cel(kc,1,1,1), E = cel(kc,1,1,kc^2), Pi(n) = cel(kc,1-n,1,1).
double elliptic_cel(double kc, double p, double a, double b);

// The complete integral of the first kind K for the complementary modulus kc = sqrt(m1), by the
// arithmetic-geometric mean; infinity for kc = 0.
double elliptic_k(double kc);

}  // namespace tw
