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
#include <vector>

#include "dynamics/body.h"
#include "kernel/counters.h"
#include "math/aabb.h"
#include "timeline/key.h"

namespace tw {

class ActivePairs;
class CallbackBook;
class PairChecks;
struct Group;
struct Simulation;

class Claims {
 public:
  Claims(Simulation& simulation, ActivePairs& pairs, PairChecks& checks,
         const CallbackBook& callbacks);

  // Claims the body's next window and looks whom it may meet there.
  void claim_window(const Body& body);
  // Whether nothing that the body has not claimed lies at or before the key.
  bool reach(const Body& body, const Key& key) const;
  // Back to the key, and what follows anew: its arc has changed there.
  void fall_back(ProcessId process, const Key& key);
  // The events by which it goes on.
  void schedule(ProcessId process);
  void withdraw(ProcessId process);
  // Finds where the arcs of the group end, before anybody relies on them.
  void test_group_end(Group& group);

  // A body has come.
  void make_room_for(BodyId id) { placed_.resize(std::max<std::size_t>(placed_.size(), id + 1)); }

  // ---- boxes ----
  // Whether the swept boxes of two that have one overlap.
  bool boxes_overlap(const Body& a, const Body& b) const;
  // It has claimed: it has a box in the hash, unless it is unbounded.
  bool placed(BodyId id) const { return placed_[id]; }
  // Its box is that of another time, until it claims again.
  void forget_box(BodyId id) { placed_[id] = false; }
  // Windows go by the typical spacing of moving bodies.
  void measure_spacing();

 private:
  void schedule_advance(const Body& body);
  void schedule_group_check(ProcessId process);
  double window_end(const Body& body) const;
  Aabb claimed_box(const Body& body, double end) const;
  void drop_parted_pairs(const Body& body);
  void find_partners(const Body& body, const Key& claimed_before);
  void meet(const Body& body, const Body& other, const Key& claimed_before);

  Simulation& sim_;
  Counters& counters_;
  ActivePairs& pairs_;
  PairChecks& checks_;
  const CallbackBook& callbacks_;
  std::vector<char> placed_;  // by body
  double cell_ = 1;           // typical spacing, m
};

}  // namespace tw
