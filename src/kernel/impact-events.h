// What the loop does for impacts, and the callbacks that see them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "kernel/counters.h"
#include "kernel/decided-ahead.h"
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
               GroupEvents& groups, const Delivery& delivery, DecidedAhead& ahead);

  void add_callback(const CollisionCallbackDef& def) { callbacks_.push_back(def); }
  // The pending impact of an active pair.
  Progress process(std::uint32_t pair);
  // What the pending impact comes to, if it can be said now; else null.  Several threads may ask at
  // once, unless users' procedures are called.
  std::unique_ptr<Decision> decide_ahead(std::uint32_t pair) const;
  bool calls_back() const { return !callbacks_.empty(); }
  // Whether one of the two is in a group.
  bool concerns_group(std::uint32_t pair) const;

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
  DecidedAhead& ahead_;
  std::vector<CollisionCallbackDef> callbacks_;
};

}  // namespace tw
