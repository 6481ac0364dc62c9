// A process: whatever owns a state queue and is advanced, checked and rolled back as one.
//
// A body is a process of its own, a link of a multibody, too: links are in one group always.  The
// state graph, rollback, regions and groups speak of processes; pairs, boxes, contacts and poses of
// bodies.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <vector>

#include "dynamics/ids.h"
#include "timeline/event-queue.h"
#include "timeline/key.h"

namespace tw {

struct Process {
  ProcessId id{};
  std::vector<BodyId> bodies;  // ascending
  Key claim;                   // every key below it has been looked at with its boxes in place
  int lonely_claims = 0;       // windows in a row in which nobody was near
  std::vector<std::uint32_t> callbacks;  // that receive its states
  EventQueue::Handle advance = EventQueue::none;
  EventQueue::Handle group_check = EventQueue::none;  // of the group that it is in
  double head_start = 0;                              // adversary scheduler

  // While the loop claims on, helpers may ask how far a claim reaches: who sees that it does sees
  // all that was done before.
  void claim_to(const Key& key) {
    claim.microstep = key.microstep;
    claim.kind = key.kind;
    claim.id = key.id;
    std::atomic_ref(claim.time).store(key.time, std::memory_order_release);
  }
  double claimed_time() const {
    // (the standard has no atomic_ref of what is const)
    return std::atomic_ref(const_cast<double&>(claim.time)).load(std::memory_order_acquire);
  }
};

}  // namespace tw
