// Policies: how the main loop goes forward.
//
// A policy decides three things: what is processed next, how far a process may claim its motion in
// one go, and who is rolled back to a discontinuity beside those whom it concerns.  Arcs, checks,
// rollback, GVT and commit are shared, and no policy changes the answer: the committed history is
// by definition the one found by always processing the least key (timeline/key.h).
//
//   timewarp            next: least key      reach: never          widen: nobody
//   retroactive:STEP    next: least key      reach: step end       widen: everybody
//   conservative        next: least key      reach: least check    widen: nobody
//
// In the last two all stand at the same time.  Their integrators halt there: with dense output they
// would not have to, but it is what the paper compares.  Where flight is closed-form nothing is
// integrated and the histories are the same, bit for bit; with rk45 they differ by its tolerance.
// Arcs of contact groups end at their checks under each.
//
// It is an object chosen at run time, so that one program can compare them.
//
// Source: the paper, sections 2.1, 2.2 and 5.2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "timeline/event-queue.h"
#include "timeline/process.h"

namespace tw {

// Whom a discontinuity rolls back beside its receivers: they lose what they have from its key on,
// their claims included.
class RollbackScope {
 public:
  explicit RollbackScope(std::size_t processes) : processes_(processes) {}

  void add(ProcessId process) { added_.push_back(process); }
  void add_all() {
    for (std::uint32_t i = 0; i < processes_; ++i) add(ProcessId{i});
  }
  const std::vector<ProcessId>& added() const { return added_; }

 private:
  std::size_t processes_;
  std::vector<ProcessId> added_;
};

class Policy {
 public:
  virtual ~Policy() = default;
  virtual std::string name() const = 0;
  // The event that is processed next.  The queue is not empty: something is left to do before the
  // run's end.
  virtual const Event& next(const EventQueue& queue) = 0;
  // The time that the process's next window may reach at most, s.  A window is never empty: where
  // this is not after the present claim, it is the shortest there is.
  virtual double may_reach(const EventQueue& queue, const Process& process) = 0;
  // Whether all stand at the same time: windows go as far as they may, and integrators halt where
  // they end and where a process is rolled back to.
  virtual bool synchronous() const { return false; }
  // Adds whom else the discontinuity at `key` rolls back.
  virtual void widen(RollbackScope& scope, const Key& key) = 0;
};

// "timewarp": the event with the least priority, each process at its own time, and nobody is rolled
// back who has nothing to do with it; "retroactive:STEP", s; "conservative".  Errors: UserError for
// any other name.
std::unique_ptr<Policy> make_policy(const std::string& name);

}  // namespace tw
