// Numbers that are polynomials of time within each step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/step-polynomials.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace tw {

void StepPolynomials::append(double time, const std::vector<double>& coefficients) {
  TW_ASSERT(coefficients.size() == static_cast<std::size_t>(count_ * (degree_ + 1)),
            "a step of another size");
  times_.push_back(time);
  coefficients_.insert(coefficients_.end(), coefficients.begin(), coefficients.end());
}

int StepPolynomials::step_from(double time) const {
  if (!(time < times_.back())) return -1;
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  return std::max(0, static_cast<int>(after - times_.begin()) - 1);
}

int StepPolynomials::step_to(double time) const {
  const auto at = std::lower_bound(times_.begin(), times_.end(), time);
  const int step = static_cast<int>(at - times_.begin()) - 1;
  return std::clamp(step, 0, std::max(0, steps() - 1));
}

void StepPolynomials::values(int i, double r, double* y) const {
  const double* c = step(i) + degree_ * count_;
  std::copy_n(c, count_, y);
  for (int k = degree_ - 1; k >= 0; --k) {
    c -= count_;
    for (int e = 0; e < count_; ++e) y[e] = y[e] * r + c[e];
  }
}

void StepPolynomials::rates(int i, double r, double* dy) const {
  const double per_time = 1 / length(i);
  std::fill_n(dy, count_, 0.0);
  for (int k = degree_; k >= 1; --k) {
    const double* c = step(i) + k * count_;
    for (int e = 0; e < count_; ++e) dy[e] = dy[e] * r + (k * per_time) * c[e];
  }
}

std::array<double, 3> StepPolynomials::rate_bounds(int i, int number, double r0, double r1) const {
  // Taylor coefficients about the middle, by Horner's shifts
  constexpr int most = 12;
  TW_ASSERT(degree_ < most, "polynomials are of a low degree");
  const double middle = 0.5 * (r0 + r1), half = 0.5 * (r1 - r0);
  const double* c = step(i) + number;
  std::array<double, most> a;
  for (int k = 0; k <= degree_; ++k) a[static_cast<std::size_t>(k)] = c[k * count_];
  for (int d = 0; d < degree_; ++d)
    for (int k = degree_ - 1; k >= d; --k)
      a[static_cast<std::size_t>(k)] += middle * a[static_cast<std::size_t>(k + 1)];
  // |p^(o)| <= sum of k!/(k - o)! |a_k| half^(k - o)
  std::array<double, 3> bounds{};
  const double per_time = 1 / length(i);
  double scale = 1;
  for (int order = 1; order <= 3; ++order) {
    double sum = 0;
    for (int k = degree_; k >= order; --k) {
      double factor = 1;
      for (int j = 0; j < order; ++j) factor *= k - j;
      sum = sum * half + factor * std::abs(a[static_cast<std::size_t>(k)]);
    }
    scale *= per_time;
    bounds[static_cast<std::size_t>(order - 1)] = scale * sum;
  }
  return bounds;
}

StepPolynomials StepPolynomials::stretch(double from) const {
  const int first = std::max(0, step_from(from));
  StepPolynomials copy(steps() > 0 ? time(first) : start(), count_, degree_);
  for (int i = first; i < steps(); ++i) {
    copy.times_.push_back(time(i + 1));
    const double* begin = step(i);
    copy.coefficients_.insert(copy.coefficients_.end(), begin, begin + count_ * (degree_ + 1));
  }
  return copy;
}

}  // namespace tw
