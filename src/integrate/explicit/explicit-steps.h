// What explicit methods of a group have in common: a solution whose cost counts as the arc's.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>

#include "base/constants.h"
#include "integrate/arc/step-method.h"
#include "integrate/explicit/runge-kutta.h"
#include "integrate/explicit/solution.h"

namespace tw {

class ExplicitSolution {
 public:
  ExplicitSolution(ArcWork& work, std::unique_ptr<Solution> solution)
      : work_(work), solution_(std::move(solution)) {}

  // A step beyond `from`, not beyond `latest`.  Null, or why there is none.
  const char* extend(double from, double latest = never) {
    const bool goes_on = solution_->extend(from, latest) && solution_->reached() > from;
    note_counts();
    if (goes_on) return nullptr;
    return solution_->failure() ? solution_->failure() : "no step";
  }
  const DenseStep& at(double time) {
    const DenseStep& step = solution_->at(time);
    note_counts();
    return step;
  }
  double reached() const { return solution_->reached(); }
  int degree() const { return solution_->method().degree(); }
  // Whether it is to be asked whether this method still suits.
  bool is_time_to_choose() const {
    return solution_->counts().steps % answer::steps_between_choices == 0;
  }

 private:
  void note_counts() {
    const Solution::Counts& now = solution_->counts();
    work_.counts.steps += now.steps - noted_.steps;
    work_.counts.rejected += now.rejected - noted_.rejected;
    work_.counts.evaluations += now.evaluations - noted_.evaluations;
    noted_ = now;
  }

  ArcWork& work_;
  std::unique_ptr<Solution> solution_;
  Solution::Counts noted_;
};

}  // namespace tw
