// What the loop does for impacts, and the callbacks that see them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/loop/group-events.h"
#include "kernel/loop/impacts-ahead.h"
#include "kernel/loop/progress.h"
#include "kernel/report/counters.h"
#include "kernel/world/definitions.h"
#include "timeline/successor.h"

namespace tw {

class ActivePairs;
class Delivery;
class Discontinuities;
struct Simulation;

class ImpactEvents {
 public:
  ImpactEvents(Simulation& simulation, const Horizon& horizon, const ActivePairs& pairs,
               Discontinuities& discontinuities, const PairChecks& checks, GroupEvents& groups,
               const Delivery& delivery);

  void add_callback(const CollisionCallbackDef& def) { callbacks_.push_back(def); }
  bool is_called(const CollisionCallback* callback) const;
  // False: there is no such one.
  bool remove(const CollisionCallback* callback);
  const std::vector<CollisionCallbackDef>& callbacks() const { return callbacks_; }
  void restore(const std::vector<CollisionCallbackDef>& callbacks) { callbacks_ = callbacks; }
  // The pending impact of an active pair.
  Progress process(std::uint32_t pair);
  // Has helpers decide what is due next, beside what the loop does with this event.
  void look_ahead(const Event& event);
  // Between runs anything may change: what was decided ahead holds no longer.
  void forget_decisions() { ahead_.forget(); }

 private:
  GroupEvents::Decided decide(BodyId a, BodyId b, const Before& before, const Known& is_known,
                              GroupCounters& counters) const;
  void decide_ahead(BodyId a, BodyId b, const Before& before, Decision& decision) const;
  bool wants_collision(const Body& a, const Body& b) const;
  void run_callbacks(const Collision& collision, const Before& before, Successor& a,
                     Successor& b) const;

  Simulation& sim_;
  Counters& counters_;
  const Horizon& horizon_;
  const ActivePairs& pairs_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
  const Delivery& delivery_;
  std::vector<CollisionCallbackDef> callbacks_;
  ImpactsAhead ahead_;
};

}  // namespace tw
