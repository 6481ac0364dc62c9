// Changes between runs: one body, or all that hang together with some.
//
// A change is a discontinuity at the present time; what is committed stays.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "kernel/callback.h"
#include "timeline/successor.h"

namespace tw {

class Discontinuities;
class GroupEvents;
class SuccessorView;
struct Simulation;

class Editing {
 public:
  Editing(Simulation& simulation, Discontinuities& discontinuities, GroupEvents& groups)
      : sim_(simulation), discontinuities_(discontinuities), groups_(groups) {}

  // `change` gets a view of the body.  Those that were placed elsewhere: it, or the links of its
  // multibody.
  std::vector<BodyId> edit(BodyId id, const std::function<void(StateView&)>& change);
  // The same of two at once, which stay where they are; they may be one.
  void edit_pair(BodyId a, BodyId b,
                 const std::function<void(SuccessorView&, SuccessorView&)>& change);
  void set_gravity(const Vec3& gravity);
  // All groups take what was set since, and wake.
  void renew_groups();
  // Whoever touches the body, or hangs on it by a spring, gets an arc without it.
  void let_go_of(BodyId id);

 private:
  Key edit_key(const std::vector<ProcessId>& concerned);
  Key key_around(const std::vector<ProcessId>& edited);
  void edit_together(const std::function<bool(BodyId)>& concerned,
                     const std::function<void(Successor&)>& change);

  Simulation& sim_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
};

}  // namespace tw
