// Several discontinuities of contact groups at once, on several threads.
//
// Impacts and single checks that come soon and have no group in common are decided side by side,
// each as if it were the first.
// The first one enters, and with it all that are at some distance from those before them, and all
// who have new arcs claim together: what should have come in between finds them entered, and takes
// them back if it concerns them, as under any other schedule.  What is decided of the others is
// kept for their own events, and used if it still holds by then.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "kernel/counters.h"
#include "kernel/decided-ahead.h"
#include "math/aabb.h"
#include "timeline/event-queue.h"

namespace tw {

class ActivePairs;
class Claims;
class Discontinuities;
class GroupEvents;
class ImpactEvents;
struct Group;
struct Simulation;

class LookAhead {
 public:
  LookAhead(Simulation& simulation, const ActivePairs& pairs, Discontinuities& discontinuities,
            GroupEvents& groups, ImpactEvents& impacts, Claims& claims, DecidedAhead& ahead);

  // An impact, or the check of a group.  False: it is still to be processed.
  bool process(const Event& event);

 private:
  // An impact, or the check of a group.
  struct Coming {
    Key key;  // of a check as far as its event knows
    std::uint32_t pair = 0;
    std::shared_ptr<Group> group;
    bool apart = true;  // from those before it
    std::unique_ptr<Decision> decision;
  };
  bool shared() const;
  bool find(const Event& event, Coming& coming) const;
  bool choose(const Event& first);
  bool has_to_wait(const Event& event) const;
  void add(Coming coming);
  Aabb room_of(const Coming& coming) const;
  void decide(Coming& coming) const;
  bool stands(const Coming& coming) const;
  bool enter();

  Simulation& sim_;
  Counters& counters_;
  const ActivePairs& pairs_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
  ImpactEvents& impacts_;
  Claims& claims_;
  DecidedAhead& ahead_;
  // scratch
  std::vector<Event> soon_;
  std::vector<Coming> next_;
  std::vector<Aabb> rooms_;
  std::vector<const Group*> groups_chosen_;
  std::vector<const Body*> movers_;
};

}  // namespace tw
