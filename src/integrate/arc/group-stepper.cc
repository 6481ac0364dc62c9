// Stepping of contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/group-stepper.h"

#include "base/constants.h"
#include "integrate/explicit/spring-steps.h"
#include "integrate/explicit/tree-steps.h"
#include "integrate/implicit/rodas-steps.h"

namespace tw {

GroupStepper::GroupStepper(const GroupStart& start) : work_(start), method_(tree_steps(work_)) {
  for (const GroupTree& tree : start.trees)
    work_.joints.emplace_back(*tree.multibody, start.time, start.end, tree.state->q, tree.state->u,
                              method_ ? method_->joint_degree() : 3);
}

GroupCounts GroupStepper::counts() const {
  GroupCounts counts = work_.counts;
  counts.factorizations = work_.system.factorizations();
  return counts;
}

bool GroupStepper::is_full() const {
  std::size_t numbers = work_.record.numbers();
  for (const JointRecord& joints : work_.joints) numbers += joints.numbers();
  return numbers > guard::most_arc_numbers;
}

bool GroupStepper::step() {
  if (is_full()) return failure_ = "too many steps", false;
  if (!method_) method_ = spring_steps(work_);
  if (!method_) method_ = rodas_steps(work_);
  failure_ = method_->step();
  if (method_->is_done()) method_ = rodas_steps(work_);
  return !failure_;
}

}  // namespace tw
