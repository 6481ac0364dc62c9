// Steps of explicit methods.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/solution.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/index.h"
#include "base/never.h"

namespace tw {
namespace {

bool all_finite(const double* numbers, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += numbers[i] - numbers[i];
  return sum == 0;
}

}  // namespace

Solution::Solution(const RungeKutta& method, std::unique_ptr<const Equations> equations,
                   double start, std::vector<double> y, std::vector<double> chart)
    : method_(method),
      equations_(std::move(equations)),
      size_(equations_->size()),
      start_(start),
      reached_(start),
      y_(std::move(y)),
      chart_(std::move(chart)) {
  TW_ASSERT(y_.size() == index(size_) && chart_.size() == index(equations_->chart_size()),
            "the start of a solution has another size than its equations");
}

bool Solution::extend(double time, double latest) {
  while (!(time < reached_) && !failure_) step(latest);
  return !failure_ || time <= reached_;
}

// By steps that end where the stretches end that somebody knows.
void Solution::halt(double time) {
  if (time < reached_) cut(time);
  while (reached_ < time && !failure_) step(time);
  halted_ = reached_;
}

void Solution::cut(double time) {
  forgotten_ += std::max(0.0, std::min(reached_, halted_) - time);
  const DenseStep& last = at(time);
  for (int e = 0; e < size_; ++e) y_[index(e)] = last.value(e, time);
  std::copy(last.chart(), last.chart() + chart_.size(), chart_.begin());
  equations_->slope(time, y_.data(), chart_.data(), slope_.data());
  ++counts_.evaluations;
  equations_->recentre(y_.data(), slope_.data(), chart_.data());
  const double from = last.start();
  while (steps_.size() > 1 && steps_[steps_.size() - 2].end > time) steps_.pop_back();
  if (from < time)
    steps_.back().end = time;
  else
    steps_.pop_back();
  reached_ = time;
  error_before_ = 1;
  failure_ = nullptr;
}

Solution::Step& Solution::step_at(double time) {
  TW_ASSERT(!steps_.empty() && time >= start_ && time <= reached_,
            "a solution from " + show(start_) + " s to " + show(reached_) + " s was asked for " +
                show(time) + " s");
  auto found = std::upper_bound(steps_.begin(), steps_.end(), time,
                                [](double t, const Step& step) { return t < step.end; });
  if (found == steps_.end()) --found;
  return *found;
}

const DenseStep& Solution::at(double time) {
  Step& step = step_at(time);
  if (!step.dense) complete(step);
  return *step.dense;
}

double Solution::step_end(double time) { return step_at(time).end; }

void Solution::combine(std::span<const double> weights, double h, const double* slopes,
                       double* sum) const {
  std::fill(sum, sum + size_, 0.0);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] == 0) continue;
    const double weight = h * weights[j];
    const double* slope = slopes + j * index(size_);
    for (int e = 0; e < size_; ++e) sum[e] += weight * slope[e];
  }
}

void Solution::set_stages(Stages& s, int from, int to) const {
  const double h = s.end - s.start;
  const double* y0 = s.y0_and_chart.data();
  thread_local std::vector<double> y;
  y.resize(index(size_));
  for (int i = from; i < to; ++i) {
    combine(method_.row(i), h, s.slopes.data(), y.data());
    if (i == method_.stages) s.change.assign(y.begin(), y.end());
    for (int e = 0; e < size_; ++e) y[index(e)] += y0[e];
    const double c = method_.c[index(i)];
    equations_->slope(c == 1 ? s.end : s.start + c * h, y.data(), y0 + size_,
                      s.slopes.data() + index(i * size_));
    ++counts_.evaluations;
  }
}

double Solution::norm(const double* error) const {
  double sum = 0;
  for (int e = 0; e < size_; ++e) {
    const double share = error[e] / allowed_[index(e)];
    sum += share * share;
  }
  return std::sqrt(sum / size_);
}

double Solution::error_of(const Stages& s) const {
  thread_local std::vector<double> error;
  error.resize(index(size_));
  const double h = s.end - s.start;
  combine(method_.error_row(0), h, s.slopes.data(), error.data());
  const double first = norm(error.data());
  if (method_.error_rows() < 2 || first == 0) return first;
  combine(method_.error_row(1), h, s.slopes.data(), error.data());
  const double second = norm(error.data());
  return first * first / std::sqrt(first * first + 0.01 * second * second);
}

double Solution::first_step() {
  const double longest = equations_->longest_step(y_.data(), slope_.data(), chart_.data());
  const double d1 = norm(slope_.data());
  if (!(d1 > 0)) return longest;
  const double probe = std::min(1 / d1, longest);
  std::vector<double> y = y_, slope(index(size_));
  for (int e = 0; e < size_; ++e) y[index(e)] += probe * slope_[index(e)];
  equations_->slope(start_ + probe, y.data(), chart_.data(), slope.data());
  ++counts_.evaluations;
  for (int e = 0; e < size_; ++e) slope[index(e)] = (slope[index(e)] - slope_[index(e)]) / probe;
  const double d2 = norm(slope.data());
  if (!(d2 > 0) || !std::isfinite(d2)) return std::isfinite(d2) ? longest : probe;
  const double tau = d1 / d2;
  return std::min(longest, tau * std::pow(0.01 / (d1 * tau), 1.0 / (method_.order + 1)));
}

// One accepted step; false: it failed.
bool Solution::step(double latest) {
  if (numbers_ > guard::most_arc_numbers) return failure_ = "too many steps", false;
  if (slope_.empty()) {
    slope_.resize(index(size_));
    allowed_.resize(index(size_));
    equations_->slope(start_, y_.data(), chart_.data(), slope_.data());
    ++counts_.evaluations;
    if (!all_finite(y_.data(), size_) || !all_finite(slope_.data(), size_))
      return failure_ = "state not finite", false;
  }
  equations_->tolerances(y_.data(), chart_.data(), allowed_.data());
  if (steps_.empty()) next_step_ = first_step();
  double h =
      std::min(next_step_, equations_->longest_step(y_.data(), slope_.data(), chart_.data()));
  const double natural = h;

  auto stages = std::make_unique<Stages>();
  stages->start = reached_;
  stages->y0_and_chart = y_;
  stages->y0_and_chart.insert(stages->y0_and_chart.end(), chart_.begin(), chart_.end());
  stages->slopes.resize(index(size_ * method_.all_stages()));
  std::copy(slope_.begin(), slope_.end(), stages->slopes.begin());

  // PI: h' = h safety error^-alpha before^beta
  const double beta = method_.memory;
  const double alpha = 1.0 / method_.error_order - 0.75 * beta;
  for (bool rejected = false;; rejected = true) {
    const bool is_last = reached_ + h >= latest;
    stages->end = is_last ? latest : reached_ + h;
    if (is_last)
      h = latest - reached_;
    else if (!(reached_ + 0.1 * h > reached_))
      return failure_ = "step size under the spacing of doubles", false;
    const int before_end = method_.stages;
    set_stages(*stages, 1, before_end + (method_.error_needs_end() ? 1 : 0));
    double error = error_of(*stages);
    if (error <= 1 && !method_.error_needs_end()) set_stages(*stages, before_end, before_end + 1);
    const double* end_slope = stages->slopes.data() + index(before_end * size_);
    const bool good = std::isfinite(error) && (error > 1 || all_finite(end_slope, size_));
    if (!good) {
      ++counts_.rejected;
      h *= 0.1;
      continue;
    }
    if (error > 1) {
      ++counts_.rejected;
      h *= std::max(0.2, 0.9 * std::pow(error, -1.0 / method_.error_order));
      continue;
    }
    error = std::max(error, 1e-10);
    double change =
        std::clamp(0.9 * std::pow(error, -alpha) * std::pow(error_before_, beta), 0.2, 6.0);
    if (rejected) change = std::min(change, 1.0);
    error_before_ = std::max(error, 1e-4);
    next_step_ = is_last && !rejected ? std::max(natural, h * change) : h * change;
    break;
  }

  ++counts_.steps;
  reached_ = stages->end;
  for (int e = 0; e < size_; ++e) y_[index(e)] += stages->change[index(e)];
  const double* end_slope = stages->slopes.data() + index(method_.stages * size_);
  std::copy(end_slope, end_slope + size_, slope_.begin());
  equations_->recentre(y_.data(), slope_.data(), chart_.data());
  numbers_ += stages->y0_and_chart.size() + index(size_ * method_.degree());
  steps_.push_back({reached_, nullptr, std::move(stages)});
  return true;
}

void Solution::complete(Step& step) const {
  Stages& s = *step.stages;
  set_stages(s, method_.stages + 1, method_.all_stages());
  const double h = s.end - s.start;
  const int count = method_.degree();
  std::vector<double> rows(index(size_ * count));
  const double* k0 = s.slopes.data();
  const double* end = k0 + index(method_.stages * size_);
  for (int e = 0; e < size_; ++e) {
    const double f0 = s.change[index(e)];
    rows[index(e)] = f0;
    rows[index(size_ + e)] = h * k0[e] - f0;
    rows[index(2 * size_ + e)] = 2 * f0 - h * (k0[e] + end[e]);
  }
  for (int i = 0; i < method_.dense_rows(); ++i)
    combine(method_.dense_row(i), h, k0, rows.data() + index((3 + i) * size_));
  step.dense = std::make_unique<DenseStep>(s.start, s.end, size_, std::move(s.y0_and_chart),
                                           rows.data(), count);
  step.stages.reset();
}

}  // namespace tw
