// One step of an explicit method and the polynomial through it, by control points.
//
// In Bernstein's form, degree d, r = (t - start)/length in [0, 1]:
//   y(t) = y0 + sum_{j=1..d} C(d,j) r^j (1-r)^(d-j) o_j.
// Over any part of the step the polynomial lies within the hull of its control points there (de
// Casteljau), its rate within that of their differences: bounds that hold by themselves.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "integrate/explicit/runge-kutta.h"
#include "math/vec.h"

namespace tw {

class DenseStep {
 public:
  // `rows`: the numbers F0, F1, .. of runge-kutta.h, one after the other.
  DenseStep(double start, double end, int size, std::vector<double> y0_and_chart,
            const double* rows, int count);

  double start() const { return start_; }
  double end() const { return end_; }
  int degree() const { return degree_; }
  const double* chart() const { return numbers_.data() + size_; }
  std::size_t numbers() const { return numbers_.size(); }

  // At a time in [start, end]; of the number `i`, or of the three from `first` on.
  double value(int i, double time) const;
  Vec3 vector(int first, double time) const;
  // Of the polynomial, 1/s.
  double rate(int i, double time) const;
  Vec3 vector_rate(int first, double time) const;
  // The numbers as polynomials of the step's fraction: the c_0 of all, then the c_1, and so on.
  std::vector<double> powers() const;

  // The control points, over [from, to] in the step, of three numbers (order 0), of their rates (1)
  // or second derivatives (2): degree() + 1 - order.
  using Control = Vec3[most_dense_degree + 1];
  void control(int order, int first, double from, double to, Control& points) const;

 private:
  double fraction(double time) const;
  const double* offsets(int j) const {
    return offsets_.data() + static_cast<std::size_t>(j - 1) * static_cast<std::size_t>(size_);
  }

  double start_, end_;
  int size_, degree_;
  std::vector<double> numbers_;  // y0, then the chart
  std::vector<double> offsets_;  // o_1 .. o_d
};

}  // namespace tw
