// The book of callbacks: when each is called next, and what a rollback does to that.
//
// Ticks are start + k period (one product, one sum); without a period the next time lives in the
// record that the last call left in the graph.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/world/definitions.h"
#include "timeline/event-queue.h"
#include "timeline/key.h"

namespace tw {

struct Simulation;
struct State;

struct CallbackRecord {
  CallbackDef def;
  Key next;                       // of the next call; time `never`: none
  double committed_next = never;  // without a period: next time after the last committed call
  EventQueue::Handle event = EventQueue::none;
  double head_start = 0;
  bool parked = false;  // a target has stopped
  bool ended = false;   // it was removed, or a target was
};

class CallbackBook {
 public:
  explicit CallbackBook(Simulation& simulation) : sim_(simulation) {}

  // UserError for targets, start or period that cannot be.
  void require_possible(const CallbackDef& def) const;
  // Its number.
  std::uint32_t add(const CallbackDef& def);
  // Those that have the body among their targets are called no more.
  void end_all_of(BodyId body);
  // It is called no more; false: there is no such one.
  bool end(const Callback* callback);
  bool is_called(const Callback* callback) const;
  // Before the first run: the next calls get the head starts of their targets.
  void take_head_starts();

  std::size_t size() const { return records_.size(); }
  const CallbackRecord& operator[](std::size_t number) const { return records_[number]; }

  // ---- calls ----
  void park(std::uint32_t number);
  // The call that was due has been made; `next`: what it answered, of those without a period.
  void move_on(std::uint32_t number, double next);
  // A target lost its states from `key` on: back to the first call that is not done any more.
  void rewind(std::uint32_t number, const Key& key);
  // A call is committed, by a state of a target, or of one that it has drawn into their group.
  void note_committed(const State& state);

  // ---- checkpoints ----
  // With the first calls that are not committed.
  std::vector<CallbackRecord> keep() const;
  // Those, and no others.
  void restore(const std::vector<CallbackRecord>& kept);

 private:
  void schedule(std::uint32_t number);
  // Of each body the least period of the callbacks that are handed its states.
  void measure_periods();
  // What is below it has been called, or is not made up for.
  Key first_open() const;
  // The first tick whose key is not below `key`.
  Key first_tick(const CallbackRecord& callback, const Key& key) const;

  Simulation& sim_;
  std::vector<CallbackRecord> records_;
};

}  // namespace tw
