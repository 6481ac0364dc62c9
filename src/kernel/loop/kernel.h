// The kernel: its parts and the main loop; what World is the face of.
//
// One event at a time is taken from the queue and processed:
//   advance      claims the next window of a body: extends its swept box, finds new active pairs
//   pair         moves the safe time of an active pair up, finds its impact, or carries it out
//   callback     calls a user's procedure with views of its targets
//   group check  refreshes the contacts of a group, finds its fissions and whether it rests
// Redraws and observers need no events: they are served at commit.
//
// The parts stand in one line: each knows those before it and none after it.
//
// Invariants (always on): keys in a queue increase; GVT never falls; nothing with a key before GVT
// is touched; a committed state is never removed.  Under --check also the validators of
// validate.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "base/work-count.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/callback-events.h"
#include "kernel/loop/checkpoint.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/commit.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/group-events.h"
#include "kernel/loop/impact-events.h"
#include "kernel/loop/pair-checks.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/delivery.h"
#include "kernel/report/statistics.h"
#include "kernel/world/bodies.h"
#include "kernel/world/editing.h"
#include "kernel/world/world.h"

namespace tw {

class Kernel {
 public:
  // ---- between runs; what concerns the future forgets and finds it anew ----
  std::uint64_t add_callback(const CallbackDef& def);
  void add_collision_callback(const CollisionCallbackDef& def);
  void remove_callback(const Callback* callback);
  void remove_callback(const CollisionCallback* callback);
  CollisionObserverPtr add_collision_observer(CollisionObserver observer, CollisionKind kind,
                                              Watch watch);
  void remove_observer(const CollisionObserver* observer);
  void add_frame_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch);
  void edit(BodyId id, const std::function<void(StateView&)>& change);
  std::shared_ptr<const Checkpoint> checkpoint();  // checkpoint.cc
  void restore(const Checkpoint& checkpoint);

  // ---- the loop ----
  RunStatus advance(double until, double slice);
  std::optional<StepReport> step(double until);
  void begin_run();
  void process_next();  // the event that the policy chooses

  StatisticsTable statistics() const;
  std::vector<DearestGroup> dearest_groups() const;
  void validate_all() const;  // aborts with what does not hold

  // ---- the parts ----
  Simulation simulation;  // what they share
  Horizon horizon{simulation};
  Delivery delivery{simulation};
  ActivePairs pairs{simulation.queue};
  CallbackBook callbacks{simulation};
  PairChecks checks{simulation, pairs};
  Claims claims{simulation, pairs, checks, callbacks};
  Discontinuities discontinuities{simulation, pairs, checks, callbacks, claims};
  GroupEvents groups{simulation, horizon, claims, discontinuities, delivery};
  ImpactEvents impacts{simulation, horizon, pairs, discontinuities, checks, groups, delivery};
  CallbackEvents callback_events{simulation, callbacks, discontinuities, groups};
  Editing editing{simulation, discontinuities, groups};
  Bodies bodies{simulation, pairs, callbacks, claims, discontinuities, editing};
  Commit commit{simulation, pairs, callbacks, delivery};

 private:
  Progress process(const Event& event);
  void take(const Event& event);  // processes, counts and validates
  StepReport describe(const Event& event) const;

  WorkCount before_ = work_count;  // of other worlds in this thread
};

}  // namespace tw
