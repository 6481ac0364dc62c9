// Methods that step a contact group: each makes pieces of motion and puts them on the arc's record,
// which knows of no method.
//
// There are three: RODAS4 for whatever touches or is stiff (rodas-steps.h), explicit ones for a
// multibody that touches nothing (tree-steps.h) and for bodies on springs (spring-steps.h).
// GroupStepper chooses.  A step's length follows from the arc alone, never from who asks how far.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "integrate/arc/group-record.h"
#include "integrate/arc/joint-record.h"
#include "integrate/implicit/group-system.h"

namespace tw {

// An arc at work.
struct ArcWork {
  const GroupStart& start;
  GroupSystem system;
  GroupRecord record;               // of the members that move by themselves
  std::vector<JointRecord> joints;  // of each multibody
  GroupCounts counts;               // factorizations apart, which the system counts
  double next_step;                 // s, that the controller would try; 0: chosen

  explicit ArcWork(const GroupStart& given)
      : start(given), system(given), record(given, system), next_step(given.first_step) {}
  ArcWork(const ArcWork&) = delete;
  ArcWork& operator=(const ArcWork&) = delete;

  double reached() const { return record.reached(); }
};

class StepMethod {
 public:
  virtual ~StepMethod() = default;
  // One accepted step, to the arc's end at most.  Null, or why there is none.
  virtual const char* step() = 0;
  // Of the polynomials that it puts on the record of joints.
  virtual int joint_degree() const { return 3; }
  // Whether what it is for is over: another one goes on from the last node.
  virtual bool is_done() const { return false; }
};

}  // namespace tw
