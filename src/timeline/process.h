// A process: whatever owns a state queue and is advanced, checked and rolled back as one.
//
// A body is a process of its own; the links of a multibody will share one.  The state graph,
// rollback, regions and groups speak of processes; pairs, boxes, contacts and poses of bodies.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

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
};

}  // namespace tw
