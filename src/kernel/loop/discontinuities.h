// Entering a discontinuity: rollback of its receivers, their new states, and what follows for
// claims and events.
//
// First all queues, then all claims, then all events: queues are wholly changed before any pair is
// looked at again.  Treated are the receivers (even where they lost nothing) and every process that
// lost a state, each from the least key it lost (doc/architecture.md, "The state graph and
// rollback").
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/check/undo-redo.h"
#include "kernel/report/counters.h"
#include "timeline/state-graph.h"
#include "timeline/successor.h"

namespace tw {

class ActivePairs;
class Before;
class CallbackBook;
class Claims;
class PairChecks;
struct Simulation;

class Discontinuities {
 public:
  Discontinuities(Simulation& simulation, ActivePairs& pairs, PairChecks& checks,
                  CallbackBook& callbacks, Claims& claims);

  // The successors give their data away.
  void enter(const Key& key, std::vector<Successor>& successors);
  // An error stops whole groups: adds the group mates of the successors, and gives all the first
  // one's error.
  void stop_group_mates(const Before& before, std::vector<Successor>& successors) const;

  // Removes the states of a process from the key on, and all that hangs on them.  Returns how many
  // went.
  std::size_t roll_back(ProcessId process, const Key& key);
  // Everything after the present time is forgotten and will be found again.
  void restart_future();
  // What stopped a process may have been mended since: try again.
  void retry_errors();
  void forget_undone() { undo_redo_.forget(); }

 private:
  std::size_t remove(ProcessId process, const Key& key, std::vector<Affected>& affected);
  void treat(const std::vector<Affected>& affected);
  void append(const Key& key, std::vector<Successor>& successors);
  void take_back_once(const Key& key, std::uint64_t checksum_before);

  Simulation& sim_;
  Counters& counters_;
  ActivePairs& pairs_;
  PairChecks& checks_;
  CallbackBook& callbacks_;
  Claims& claims_;
  UndoRedo undo_redo_;
};

}  // namespace tw
