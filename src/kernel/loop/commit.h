// GVT and commit: what lies before GVT is final.
//
// GVT is the least of every pair's safe time, every other pending event's time and every moving
// process's claimed time.  At commit states enter the hash, collisions reach observers and frames
// their sinks, all in time order and once; then states nobody can ask for are freed.
//
// Invariant (always on): GVT never falls.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <exception>

#include <memory>
#include "kernel/report/counters.h"

#include "kernel/check/state-trace.h"
#include "timeline/key.h"

namespace tw {

class ActivePairs;
class CallbackBook;
class Delivery;
struct Simulation;
struct State;

class Commit {
 public:
  Commit(Simulation& simulation, const ActivePairs& pairs, CallbackBook& callbacks,
         Delivery& delivery);

  // A run to `until`, s; what is committed in it is delivered until the wall clock passes
  // `wall_end`.
  void begin_run(double until, double wall_end);
  void note_events(std::uint64_t count) { events_since_gvt_ += static_cast<long>(count); }
  bool gvt_is_due() const;
  // Moves GVT up and commits what it passes, but nothing later than the run's end.
  void update_gvt();
  // Everything up to the end is final: nothing that could still change it is left.
  bool finished() const;

 private:
  double compute_gvt() const;
  void commit(double limit, bool inclusive);
  std::exception_ptr error_before(double& limit, bool& inclusive) const;
  void commit_states(double limit, bool inclusive);
  void commit_state(State& state);
  void count(const State& state);
  void free_states(double limit);

  Simulation& sim_;
  Counters& counters_;
  const ActivePairs& pairs_;
  CallbackBook& callbacks_;
  Delivery& delivery_;
  double until_ = 0;
  double wall_end_ = never;
  long events_since_gvt_ = 0;
  std::unique_ptr<StateTrace> trace_;  // null unless asked for
};

}  // namespace tw
