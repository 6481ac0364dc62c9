// What the loop does for impacts, and the callbacks that see them.
//
// On several threads the next few of groups that are pending at some distance from each other are
// decided at once, each as if it were the first; those whose decision still holds when the ones
// before have entered enter, too, and all who have new arcs claim together.  What should have come
// in between finds them entered, and takes them back if it concerns them, as under any other
// schedule.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "kernel/counters.h"
#include "kernel/definitions.h"
#include "kernel/group-events.h"
#include "kernel/progress.h"
#include "math/aabb.h"
#include "timeline/successor.h"

namespace tw {

class ActivePairs;
class Claims;
class Delivery;
class Discontinuities;
struct Simulation;

class ImpactEvents {
 public:
  ImpactEvents(Simulation& simulation, const ActivePairs& pairs, Discontinuities& discontinuities,
               GroupEvents& groups, Claims& claims, const Delivery& delivery);

  void add_callback(const CollisionCallbackDef& def) { callbacks_.push_back(def); }
  // The pending impact of an active pair.
  Progress process(std::uint32_t pair);

 private:
  // What an impact comes to.
  struct Decision {
    std::uint32_t pair = 0;
    Key key;
    GroupEvents::Decided result;
    GroupCounters counters;
    ReadLog log;
    bool made = false;
  };
  GroupEvents::Decided decide(std::uint32_t pair, const Before& before, const Known& is_known,
                              GroupCounters& counters) const;
  bool concerns_group(std::uint32_t pair) const;
  Aabb room_of(std::uint32_t pair) const;
  void find_next(std::uint32_t first);
  void decide_ahead(Decision& decision) const;
  void enter_next();
  bool process_together(std::uint32_t first);
  bool wants_collision(const Body& a, const Body& b) const;
  void run_callbacks(const Collision& collision, const Before& before, Successor& a,
                     Successor& b) const;

  Simulation& sim_;
  Counters& counters_;
  const ActivePairs& pairs_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
  Claims& claims_;
  const Delivery& delivery_;
  std::vector<CollisionCallbackDef> callbacks_;
  // scratch
  std::vector<std::uint32_t> soon_;
  std::vector<std::unique_ptr<Decision>> next_;
  std::vector<Aabb> rooms_;
  std::vector<const Body*> movers_;
};

}  // namespace tw
