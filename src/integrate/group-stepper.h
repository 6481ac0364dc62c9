// Steps through a contact group, and their record: of RODAS4, or, where nothing touches and an
// explicit method takes longer ones, of that.
//
// Error of a step: RMS over members of dx and radius dtheta over the position tolerance, dv and
// radius dw over the velocity tolerance; stretches are not weighed.  A rejected step's successor
// does not grow.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/group-arc.h"
#include "integrate/group-record.h"
#include "integrate/group-system.h"
#include "integrate/joint-record.h"
#include "integrate/solution.h"

namespace tw {

class GroupStepper {
 public:
  // `start` must outlive it.
  explicit GroupStepper(const GroupStart& start);

  // One accepted step.  False: it stopped for the reason that `failure` gives.
  bool step() {
    if (!chosen_) choose_method();
    if (!explicit_) return implicit_step();
    return joints_.empty() ? spring_step() : tree_step();
  }
  const char* failure() const { return failure_; }

  const GroupSystem& system() const { return system_; }
  const GroupRecord& record() const { return record_; }
  const JointRecord& joints(int tree) const { return joints_[static_cast<std::size_t>(tree)]; }
  double next_step() const { return next_step_; }
  GroupCounts counts() const;

 private:
  bool implicit_step();
  void start_alone();
  bool swings_here();
  void choose_method();
  void leave_explicit();
  bool extend_explicit(double from, double latest = never);
  bool tree_step();
  int parts_of(const std::vector<double>& powers) const;
  bool spring_step();
  double first_step(GroupScratch& s) const;
  double unforeseen(double h, GroupScratch& s) const;
  double friction_doubt(const GroupScratch& s) const;
  template <int i>
  bool set_stage(double h, GroupScratch& s);
  bool try_step(double h, GroupScratch& s, double& error);
  double error_norm(const GroupScratch& s) const;
  double fastest_turn(const GroupScratch& s) const;
  double velocity_change(const GroupScratch& s) const;
  void accept(double time, GroupScratch& s);
  void load_joints(GroupScratch& s);
  void append_joints(double time, GroupScratch& s);

  const GroupStart& start_;
  GroupSystem system_;
  GroupRecord record_;
  std::vector<JointRecord> joints_;  // of each multibody
  std::vector<double> joint_positions_, joint_velocities_;
  std::unique_ptr<Solution> explicit_;  // of a multibody that touches nothing, of springs
  bool nonstiff_ = false;               // the multibody that touches nothing
  bool chosen_ = false;
  GroupCounts counts_;
  double next_step_;
  const char* failure_ = nullptr;
};

}  // namespace tw
