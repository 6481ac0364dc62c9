// Explicit Runge-Kutta methods with an error estimate and a polynomial through each step.
//
//   k_i = f(t + c_i h, y + h sum_j a_ij k_j),  i = 0 .. stages-1;
// row number `stages` of a gives the end y1 = y + h sum b_j k_j, and k there, the slope at the end,
// is the first stage of the next step.  The rows after it are extra stages, for the polynomial.
//
// Error, with weights e and, where the method has them, a second row e3 of low order:
//   |h e.k|  or  |h e.k|^2 / sqrt(|h e.k|^2 + 0.01 |h e3.k|^2).
//
// The polynomial, with r = (t - t0)/h in [0, 1] and the numbers
//   F0 = y1 - y0,  F1 = h k_0 - F0,  F2 = 2 F0 - h (k_0 + k_end),  F3.. = h d.k, row after row:
//   y0 + r (F0 + (1-r) (F1 + r (F2 + (1-r) (F3 + r (F4 + ...))))):
// its ends have the values and slopes of the steps, so rates are continuous.
//
// Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.4-6.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

namespace tw {

struct RungeKutta {
  const char* name;
  int order;                       // of the step
  int dense_order;                 // of the polynomial
  int error_order;                 // an estimate is proportional to h to this power
  double memory;                   // share of the step before in the control of steps (PI), 0: none
  int stages;                      // up to the end of the step, the slope there not counted
  int extra_stages;                // for the polynomial
  std::span<const double> c;       // stages + 1 + extra_stages
  std::span<const double> a;       // row i has i numbers
  std::span<const double> errors;  // one row or two, each of stages + 1
  std::span<const double> dense;   // rows of all stages

  int all_stages() const { return stages + 1 + extra_stages; }
  std::span<const double> row(int i) const {
    return a.subspan(static_cast<std::size_t>(i * (i - 1) / 2), static_cast<std::size_t>(i));
  }
  std::span<const double> error_row(int i) const {
    const auto width = static_cast<std::size_t>(stages + 1);
    return errors.subspan(static_cast<std::size_t>(i) * width, width);
  }
  int error_rows() const { return static_cast<int>(errors.size()) / (stages + 1); }
  // Whether the slope at the end takes part in the error estimate.
  bool error_needs_end() const { return error_row(0).back() != 0; }
  int dense_rows() const { return static_cast<int>(dense.size()) / all_stages(); }
  std::span<const double> dense_row(int i) const {
    const auto width = static_cast<std::size_t>(all_stages());
    return dense.subspan(static_cast<std::size_t>(i) * width, width);
  }
  // Of the polynomial.
  int degree() const { return 3 + dense_rows(); }
};

// The most that degree() is.
inline constexpr int most_dense_degree = 7;

// Dormand and Prince's method of order 8 with estimates of orders 5 and 3, 12 stages, 3 more for
// the polynomial of order 7: what is accurate.
extern const RungeKutta dop853;
// Tsitouras' 5(4), 6 stages, polynomial of order 4 without more: for errors above 1e-5.
extern const RungeKutta tsit5;
// Cash and Karp's 5(4), 6 stages, one more for a polynomial of order 4: the paper's.
extern const RungeKutta cash_karp;

}  // namespace tw
