// Group checks of one instant, decided side by side before their events.
//
// Checks of one instant hardly ever concern each other: each is decided as if it were the first,
// and its event uses that if what it was made of still stands before its key by then; else it
// decides anew.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "groups/group.h"
#include "kernel/loop/decided-ahead.h"
#include "timeline/event-queue.h"

namespace tw {

struct Simulation;

class ChecksAhead {
 public:
  // Decides what a check comes to, its concerned and key being set; false: it can't be said now.
  // Several threads may ask at once.
  using Decide = std::function<bool(Decision&)>;

  ChecksAhead(Simulation& simulation, Decide decide);

  // Has all checks that are due then decided, if they are several.
  void decide_instant(double when);
  // What was decided for the key and for these; null: nothing, or it holds no more.
  std::unique_ptr<Decision> take(const Key& key, const std::vector<ProcessId>& concerned);
  // Whether the next event is one of an instant that was decided: a bad moment to pause.
  bool amid_decisions() const;
  void forget();

 private:
  std::shared_ptr<Group> checked_by(const Event& event) const;
  Groups due_groups(double when) const;
  std::vector<std::unique_ptr<Decision>> due_families(double when) const;

  Simulation& sim_;
  const Decide decide_;
  DecidedAhead ahead_;
  double decided_at_ = -never;  // s: the instant whose checks were decided together
};

}  // namespace tw
