// The solution of differential equations from a start on, made step by step as far as somebody
// asks.
//
// Steps follow from the equations and the start alone, never from who asks for what time: same
// start, same bits.  Nothing is computed before it is needed: the first step when somebody asks for
// a time after the start, a step's polynomial when somebody looks inside it.
//
// Control of steps: RMS of the errors in the allowed ones, safety 0.9, a change by 1/5 to 6, PI
// where the method says so, no growth right after a rejection.  The first step: with the error
// norm |.|, d1 = |y'|, d2 = |y''| (a difference over the time in which y changes by what is
// allowed), the solution changes within tau = d1/d2, and a step of order p errs by about
// d1 tau (h/tau)^(p+1); a hundredth of the allowed is aimed at.  No length and no time of its own.
//
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.4; K. Gustafsson,
// ACM Transactions on Mathematical Software 17 (1991), 533-554, for PI.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "base/never.h"
#include "integrate/explicit/dense-step.h"
#include "integrate/explicit/equations.h"

namespace tw {

class Solution {
 public:
  // `y` and `chart`: at the start.
  Solution(const RungeKutta& method, std::unique_ptr<const Equations> equations, double start,
           std::vector<double> y, std::vector<double> chart = {});

  // Makes steps until one ends beyond `time`, none beyond `latest` > time.  False: it stopped
  // before; see failure().
  bool extend(double time, double latest = never);
  // Ends a step at `time` >= start, as who stands there and knows no further does: steps that
  // reach beyond are forgotten, and the next starts there.  What it gives depends on who asked.
  void halt(double time);
  double start() const { return start_; }
  // The end of the last step; the start where there is none.
  double reached() const { return reached_; }
  // Where a step was last ended by halt.
  double halted() const { return halted_; }
  // The length of what was asked for by halt and forgotten, s.
  double forgotten() const { return forgotten_; }
  // The step with start <= time < end, of what was reached; at reached() itself the last one.
  const DenseStep& at(double time);
  // Where that step ends.
  double step_end(double time);
  // Why it stopped, or null: a state that is not finite, a step under the spacing of doubles, more
  // steps than are kept.
  const char* failure() const { return failure_; }

  const RungeKutta& method() const { return method_; }
  const Equations& equations() const { return *equations_; }
  struct Counts {
    std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  // A step without its polynomial: y0 and chart, and all slopes up to that at the end, one row
  // each.
  struct Stages {
    double start, end;
    std::vector<double> y0_and_chart, slopes;
    std::vector<double> change;  // y1 - y0
  };
  struct Step {
    double end;
    std::unique_ptr<const DenseStep> dense;
    std::unique_ptr<Stages> stages;  // null where `dense` stands
  };

  // Not beyond `latest`.
  bool step(double latest = never);
  void cut(double time);
  Step& step_at(double time);
  double first_step();
  // Slopes of the stages [from, to) after y0, into rows of `slopes`.
  void set_stages(Stages& stages, int from, int to) const;
  // Sum of a row of weights over slopes, times h.
  void combine(std::span<const double> weights, double h, const double* slopes, double* sum) const;
  double error_of(const Stages& stages) const;
  double norm(const double* error) const;
  void complete(Step& step) const;

  const RungeKutta& method_;
  std::unique_ptr<const Equations> equations_;
  int size_;
  double start_, reached_, halted_ = -never, forgotten_ = 0;
  std::vector<double> y_, chart_, slope_;  // where it has come to
  std::vector<double> allowed_;
  double next_step_ = 0, error_before_ = 1;
  bool rejected_before_ = false;
  std::deque<Step> steps_;
  const char* failure_ = nullptr;
  std::size_t numbers_ = 0;
  mutable Counts counts_;
};

}  // namespace tw
