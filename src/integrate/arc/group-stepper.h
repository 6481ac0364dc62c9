// Steps through a contact group, by the method that suits it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/arc/step-method.h"

namespace tw {

class GroupStepper {
 public:
  // `start` must outlive it.
  explicit GroupStepper(const GroupStart& start);

  // One accepted step.  False: it stopped for the reason that `failure` gives.
  bool step();
  const char* failure() const { return failure_; }

  const GroupSystem& system() const { return work_.system; }
  const GroupRecord& record() const { return work_.record; }
  const JointRecord& joints(int tree) const { return work_.joints[static_cast<std::size_t>(tree)]; }
  double next_step() const { return work_.next_step; }
  GroupCounts counts() const;

 private:
  bool is_full() const;

  ArcWork work_;
  std::unique_ptr<StepMethod> method_;  // null: none is chosen yet
  const char* failure_ = nullptr;
};

}  // namespace tw
