// Roots of functions of one variable.
//
// Source: R. P. Brent, "Algorithms for Minimization without Derivatives", 1973, chapter 4
// (inverse quadratic interpolation and secant steps, safeguarded by bisection).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <utility>

namespace tw {

// A change of sign, narrowed until no double lies between the ends (or f is 0 at one).
struct Bracket {
  double left = 0, right = 0;      // left < right, or equal where f is as good as 0
  double f_left = 0, f_right = 0;  // opposite signs, or equal
};

// Needs f(left) and f(right) of opposite signs (0 counts as either).  Full convergence: the ends
// differ by at most two units in the last place; or, where |f| comes to be no more than
// `rounding`, f is no more than a few of these at the end with the sign of f(left): nearer, signs
// may be noise, which would be bisected on and on.  A function of its arguments alone.
template <class F>
Bracket find_root(F&& f, double left, double right, double f_left, double f_right,
                  double rounding = 0) {
  // b is the best estimate, c the end with the other sign, a the one before b
  double a = left, b = right, fa = f_left, fb = f_right;
  double c = a, fc = fa, step = b - a, last_step = step;

  for (int i = 0; i < 200; ++i) {
    // keep the sign change between b and c, and b the smaller of the two
    if ((fb > 0) == (fc > 0)) {
      c = a, fc = fa;
      step = last_step = b - a;
    }
    if (std::abs(fc) < std::abs(fb)) {
      a = b, b = c, c = a;
      fa = fb, fb = fc, fc = fa;
    }

    const double ulp = std::numeric_limits<double>::epsilon() * std::abs(b);
    const double half = 0.5 * (c - b);
    if (fb == 0 || std::abs(c - b) <= ulp) break;

    if (std::abs(last_step) < ulp || std::abs(fa) <= std::abs(fb)) {
      step = last_step = half;
    } else {
      // interpolate: step = p/q
      double p, q;
      const double s = fb / fa;
      if (a == c) {
        p = 2 * half * s;
        q = 1 - s;
      } else {
        const double r = fb / fc, u = fa / fc;
        p = s * (2 * half * u * (u - r) - (b - a) * (r - 1));
        q = (u - 1) * (r - 1) * (s - 1);
      }
      if (p > 0) q = -q;
      p = std::abs(p);
      // accept if it stays inside and shrinks fast enough
      if (2 * p < std::min(3 * half * q - std::abs(ulp * q), std::abs(last_step * q))) {
        last_step = step;
        step = p / q;
      } else {
        step = last_step = half;
      }
    }

    a = b, fa = fb;
    b += std::abs(step) > 0.5 * ulp ? step : std::copysign(0.5 * ulp, half);
    if (b == a) b = std::nextafter(a, c);
    fb = f(b);
    if (std::abs(fb) > rounding || fb == 0) continue;
    if ((fb > 0) == (f_left > 0)) return {b, b, fb, fb};
    const double back = b - 2 * rounding * (right - left) / std::abs(f_right - f_left);
    const double f_back = back > left ? f(back) : f_left;
    if (back > left && (f_back > 0) == (f_left > 0)) return {back, b, f_back, fb};
    rounding = 0;  // it is more than was thought
  }

  if (fb == 0) return {b, b, 0, 0};
  if (b < c) return {b, c, fb, fc};
  return {c, b, fc, fb};
}

}  // namespace tw
