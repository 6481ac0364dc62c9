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

#include "groups/regroup.h"
#include "kernel/counters.h"
#include "kernel/progress.h"

namespace tw {

class Claims;
class Delivery;
class Discontinuities;
struct Simulation;

class GroupEvents {
 public:
  GroupEvents(Simulation& simulation, Claims& claims, Discontinuities& discontinuities,
              const Delivery& delivery);

  // Claims windows of a process until its arcs are known to `key`.  False: something else comes
  // first, perhaps; whoever asked has done nothing, and is asked again when its event is due once
  // more.
  bool await(ProcessId id, const Key& key);
  bool await(const Region& region, const Key& key);
  // The same of all that a discontinuity of these bodies may concern.
  bool await_struck(std::span<const BodyId> bodies, const Key& key);
  // The groups that follow a discontinuity that changed some of the successors; adds those of all
  // others that take part.
  // `struck_at`: see RegroupRequest.
  Progress regroup(const Key& key, std::vector<Successor>& successors, Cause cause,
                   std::span<const ContactPoint> struck_at = {});
  // After an edit between runs.
  void regroup_edited(const Key& key, std::vector<Successor>& successors);
  // The check where the arc of a group's member ends.
  Progress check(ProcessId id);
  // Between runs anything may have changed: what was decided ahead no longer holds.
  void begin_run() {
    decided_at_ = -never;
    decisions_.clear();
  }

 private:
  // What a check comes to, decided ahead of its event together with the others of its instant.
  struct Decision {
    Key key;
    std::vector<ProcessId> concerned;
    std::vector<Successor> successors;
    GroupCounters counters;
    ReadLog log;
  };
  using Decided = std::variant<Regrouped, Waits>;
  Decided decide(const Before& before, const std::vector<ProcessId>& concerned, Cause cause,
                 const Known& is_known, GroupCounters& counters) const;
  void decide_ahead(double when);
  Groups due_groups(double when) const;
  std::unique_ptr<Decision> decide_ahead(const std::shared_ptr<Group>& group, double when) const;
  std::unique_ptr<Decision> decided(const Key& key, const std::vector<ProcessId>& concerned);
  Progress stop_driven(ProcessId id);
  bool own_check_before(ProcessId id, const Key& key) const;
  bool claims_reach(ProcessId id, const Key& key) const;
  bool known(ProcessId id, const Key& key) const;

  Simulation& sim_;
  Counters& counters_;
  Claims& claims_;
  Discontinuities& discontinuities_;
  const Delivery& delivery_;
  double decided_at_ = -never;                        // s
  std::vector<std::unique_ptr<Decision>> decisions_;  // for that instant, by key
};

}  // namespace tw
