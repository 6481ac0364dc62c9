// How far the arc of a process is known: who may rely on what, and when.
//
// A process has *claimed* as far as nothing of it is yet to be found out; beyond that it may be
// rolled back, or its arc cut.  Whoever decides something at a key asks here whether the arcs that
// it would read are known as far; what is not is awaited (group-events.h), or given up by whoever
// decides ahead.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/loop/simulation.h"

namespace tw {

class Horizon {
 public:
  explicit Horizon(const Simulation& simulation) : sim_(simulation) {}

  // Whether its claims reach the key.
  bool is_claimed(ProcessId id, const Key& key) const;
  // Whether its arc is known as far as the key: nothing can come before it, its own check of that
  // instant among it.
  bool is_known(ProcessId id, const Key& key) const;
  // Whether, besides, several threads may look at it at once: it is complete.
  bool may_be_shared(ProcessId id, const Before& before) const;
  // Whether a helper may read the state while the loop goes on: its arc is known beyond the key,
  // and it is the last one before it.  A claim is that of the last state: what has been replaced
  // meanwhile need not be complete.
  bool may_be_read_beside(const State& state, const Key& key) const;
  // Whether to look at the state's arc may complete it.
  static bool is_open(const State& state);

 private:
  bool own_check_before(ProcessId id, const Key& key) const;

  const Simulation& sim_;
};

}  // namespace tw
