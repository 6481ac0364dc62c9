// What the loop does for contact groups: waiting until arcs are known, regrouping, group checks.
//
// The decisions are those of groups/, functions of what stands before a key; here are the claims
// and events around them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "groups/regroup/regroup.h"
#include "kernel/loop/checks-ahead.h"
#include "kernel/loop/horizon.h"
#include "kernel/loop/progress.h"
#include "kernel/report/counters.h"
#include "timeline/event-queue.h"

namespace tw {

class Before;
class Claims;
class Delivery;
class Discontinuities;
struct Simulation;

class GroupEvents {
 public:
  GroupEvents(Simulation& simulation, const Horizon& horizon, Claims& claims,
              Discontinuities& discontinuities, const Delivery& delivery);

  // Claims windows of a process until its arcs are known to `key`.  False: something else comes
  // first, perhaps; whoever asked has done nothing, and is asked again when its event is due once
  // more.
  bool await(ProcessId id, const Key& key);
  bool await(const Region& region, const Key& key);
  // The same of all that a discontinuity of these bodies may concern.
  bool await_struck(std::span<const BodyId> bodies, const Key& key);
  // The groups that follow a discontinuity that changed some of the successors; adds those of all
  // others that take part.
  Progress regroup(const Key& key, std::vector<Successor>& successors, Cause cause);
  // The same as a function of what stands; `is_known`: whose arcs may be relied on.
  using Decided = std::variant<Regrouped, Waits>;
  Decided regrouped(const Before& before, const Known& is_known, Cause cause,
                    const std::vector<Successor>& successors, GroupCounters& counters) const;
  // After an edit between runs.
  void regroup_edited(const Key& key, std::vector<Successor>& successors);
  // The check where the arc of a group's member ends.
  Progress check(ProcessId id);
  // Whether the next event is one of an instant that was decided ahead: a bad moment to pause.
  bool amid_decisions() const { return ahead_.amid_decisions(); }
  // The end tests of the groups that a decision made, which the claims after it would make.
  void test_ends(Decision& decision) const;
  // Between runs anything may change: what was decided ahead holds no longer.
  void forget_decisions() { ahead_.forget(); }

 private:
  Decided decide(const Before& before, const std::vector<ProcessId>& concerned, Cause cause,
                 const Known& is_known, GroupCounters& counters) const;
  std::vector<ProcessId> concerned(const Before& before, const std::shared_ptr<Group>& group) const;
  bool decide_ahead(Decision& decision) const;
  Progress stop_driven(ProcessId id);
  Region region_struck(std::span<const BodyId> bodies, const Before& before) const;

  Simulation& sim_;
  Counters& counters_;
  const Horizon& horizon_;
  Claims& claims_;
  Discontinuities& discontinuities_;
  const Delivery& delivery_;
  ChecksAhead ahead_;
};

}  // namespace tw
