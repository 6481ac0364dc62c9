// Claims: how far a process's motion is known to all, how far a body's swept box reaches, and whom
// it may meet there.
//
// A body claims its motion window by window.  Its box then covers the *continuous* motion from GVT
// to the claimed time; a box that comes to overlap another makes the pair active, and the pair is
// looked at from the lesser claimed time before this claim, which may lie in the past of one of
// them (the paper, section 4.5 and figure 5).  The member of a group claims up to where its arc
// ends, which is tested first; there it waits for the group check.
//
// Cost: one insertion into the spatial hash and one query a window.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "dynamics/body.h"
#include "kernel/loop/pair-checks.h"
#include "kernel/report/counters.h"
#include "math/aabb.h"
#include "timeline/event-queue.h"

namespace tw {

class ActivePairs;
class CallbackBook;
struct Group;
struct Simulation;

class Claims {
 public:
  Claims(Simulation& simulation, ActivePairs& pairs, PairChecks& checks,
         const CallbackBook& callbacks);

  // Claims the body's next window and looks whom it may meet there.
  void claim_window(const Body& body) {
    const Body* const one = &body;
    claim_windows({&one, 1});
  }
  // The same of several at once: each pair of them is looked at once, and all by as many threads as
  // there are.
  void claim_windows(std::span<const Body* const> bodies);
  // Of the body of an advance event, and of all that are due with it.
  void claim_due(const Event& event);
  // Back to the key, and what follows anew: its arc has changed there.
  void fall_back(ProcessId process, const Key& key);
  // The events by which it goes on.
  void schedule(ProcessId process);
  void withdraw(ProcessId process);
  // Finds where the arcs of these groups end, before anybody relies on them; each once.
  void test_ends(std::span<const std::shared_ptr<Group>> groups);

  // A body has come.
  void make_room_for(BodyId id) { placed_.resize(std::max<std::size_t>(placed_.size(), id + 1)); }

  // ---- boxes ----
  // Whether the swept boxes of two that have one overlap.
  bool boxes_overlap(const Body& a, const Body& b) const;
  // It has claimed: it has a box in the hash, unless it is unbounded.
  bool placed(BodyId id) const { return placed_[id]; }
  // Its box is that of another time, until it claims again.
  void forget_box(BodyId id) { placed_[id] = false; }
  // A fixed one that has claimed all, and is back: others meet it as they claim.
  void place_fixed(const Body& body);
  // Windows go by the typical spacing of moving bodies.
  void measure_spacing();

 private:
  // A window that is being claimed.
  struct Window {
    const Body* body;
    Key before;  // what had been claimed
    double end;  // s; `never`: of a fixed body
    Aabb box;
    std::vector<BodyId> near;  // whose boxes overlap
  };
  void schedule_advance(const Body& body);
  void schedule_group_check(ProcessId process);
  void test_group_ends(std::span<const Body* const> bodies);
  void claim_some(std::span<const Body* const> bodies);
  bool begin(const Body& body, Window& window);
  double window_end(const Body& body) const;
  Aabb claimed_box(const Body& body, double end) const;
  void drop_parted_pairs(const Body& body);
  void find_near(const Body& body, std::vector<BodyId>& near) const;
  void meet_all(std::span<const Window> windows);

  Simulation& sim_;
  Counters& counters_;
  ActivePairs& pairs_;
  PairChecks& checks_;
  const CallbackBook& callbacks_;
  std::vector<char> placed_;  // by body
  // scratch
  std::vector<Event> due_;
  std::vector<const Body*> due_bodies_;
  std::vector<Window> windows_;
  std::vector<Meeting> meetings_;
  std::vector<std::size_t> place_in_windows_;  // by body, + 1; 0: it claims none
  double cell_ = 1;                            // typical spacing, m
};

}  // namespace tw
