// What the loop does for callbacks: what they see, and what remains of them in the graph.
//
// Every target gets a state of the callback's key, all in one ring, also those that were only read:
// a *record* that carries the old arc along where the motion did not change.  So a callback runs
// again exactly when one of its targets is rolled back below it.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/loop/progress.h"
#include "kernel/report/counters.h"
#include "kernel/world/state-view.h"

namespace tw {

class CallbackBook;
class Discontinuities;
class GroupEvents;
struct Simulation;

class CallbackEvents {
 public:
  CallbackEvents(Simulation& simulation, CallbackBook& book, Discontinuities& discontinuities,
                 GroupEvents& groups);

  // The call that is due.
  Progress process(std::uint32_t number);

 private:
  // Memory of one call, kept for the next: no call is within another.
  struct Scratch {
    std::vector<Successor> successors;
    std::vector<SuccessorView> views;
    std::vector<StateView*> pointers;

    struct Use {
      explicit Use(Scratch& scratch) : of(scratch) {}
      ~Use() {
        of.pointers.clear();
        of.views.clear();
        of.successors.clear();
      }
      Use(const Use&) = delete;
      Use& operator=(const Use&) = delete;
      Scratch& of;
    };
  };

  Simulation& sim_;
  Counters& counters_;
  CallbackBook& book_;
  Discontinuities& discontinuities_;
  GroupEvents& groups_;
  Scratch scratch_;
};

}  // namespace tw
