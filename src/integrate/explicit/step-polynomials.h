// Numbers that are polynomials of time within each step of an integrator.
//
// Of every step: its end, and for each number the coefficients c of
//   y(r) = sum c_k r^k,  r in [0, 1] the fraction of the step.
// Degree and count are the same for all steps.  What a number means from one step to the next is
// its owner's business: rotations are measured from each step's start.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace tw {

class StepPolynomials {
 public:
  StepPolynomials(double start, int count, int degree)
      : count_(count), degree_(degree), times_{start} {}

  int steps() const { return static_cast<int>(times_.size()) - 1; }
  double time(int node) const { return times_[static_cast<std::size_t>(node)]; }
  double start() const { return times_.front(); }
  double reached() const { return times_.back(); }
  double length(int step) const { return time(step + 1) - time(step); }
  std::size_t numbers() const { return coefficients_.size(); }
  int degree() const { return degree_; }
  int count() const { return count_; }

  // A further step to `time`; `coefficients`: the c_0 of all numbers, then the c_1, and so on.
  void append(double time, const std::vector<double>& coefficients);
  // The step that holds `time`, its start included (-1: at or after the last node).
  int step_from(double time) const;
  // The same with its end included; the first for its start.
  int step_to(double time) const;
  double fraction(int step, double time) const { return (time - this->time(step)) / length(step); }

  // All numbers at a fraction of a step, and their derivatives by time.
  void values(int step, double r, double* y) const;
  void rates(int step, double r, double* dy) const;
  // Bounds on the magnitudes of the first three derivatives by time of a number over [r0, r1]: at
  // the middle, and how far the higher derivatives may take them from there.
  std::array<double, 3> rate_bounds(int step, int number, double r0, double r1) const;

  // A copy from the step that holds `from` on.
  StepPolynomials stretch(double from) const;

 private:
  const double* step(int i) const {
    return coefficients_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(count_) *
                                      static_cast<std::size_t>(degree_ + 1);
  }

  int count_, degree_;
  std::vector<double> times_, coefficients_;
};

}  // namespace tw
