// What the loop does for impacts, and the callbacks that see them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/counters.h"
#include "kernel/definitions.h"
#include "kernel/group-events.h"
#include "kernel/progress.h"
#include "timeline/successor.h"

namespace tw {

class ActivePairs;
class Delivery;
class Discontinuities;
struct Simulation;

class ImpactEvents {
 public:
  ImpactEvents(Simulation& simulation, const ActivePairs& pairs, Discontinuities& discontinuities,
               GroupEvents& groups, const Delivery& delivery);

  void add_callback(const CollisionCallbackDef& def) { callbacks_.push_back(def); }
  // The pending impact of an active pair.
  Progress process(std::uint32_t pair);

 private:
  GroupEvents::Decided decide(std::uint32_t pair, const Before& before, const Known& is_known,
                              GroupCounters& counters) const;
  bool wants_collision(const Body& a, const Body& b) const;
  void run_callbacks(const Collision& collision, const Before& before, Successor& a,
                     Successor& b) const;

  Simulation& sim_;
  Counters& counters_;
  const ActivePairs& pairs_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
  const Delivery& delivery_;
  std::vector<CollisionCallbackDef> callbacks_;
};

}  // namespace tw
