// The maximum of a function of one variable.
//
// Source: J. Kiefer, "Sequential minimax search for a maximum", 1953 (golden section).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw {

// Where f, which rises and then falls between left and right, is greatest: within `tolerance` > 0,
// or as near as its rounding tells.
template <class F>
double greatest_at(F&& f, double left, double right, double tolerance) {
  constexpr double golden = 0.6180339887498949;
  double low = right - golden * (right - left), high = left + golden * (right - left);
  double at_low = f(low), at_high = f(high);
  while (right - left > tolerance) {
    if (at_low > at_high) {
      right = high;
      high = low, at_high = at_low;
      low = right - golden * (right - left), at_low = f(low);
    } else {
      left = low;
      low = high, at_low = at_high;
      high = left + golden * (right - left), at_high = f(high);
    }
  }
  return 0.5 * (left + right);
}

}  // namespace tw
