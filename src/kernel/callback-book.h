// The book of callbacks: when each is called next, and what a rollback does to that.
//
// Ticks are start + k period (one product, one sum); without a period the next time lives in the
// record that the last call left in the graph.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/definitions.h"
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
  bool ended = false;   // a target was removed
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
  // Of each: the key of the first call that is not committed, and the committed next time.
  std::vector<std::pair<Key, double>> committed_ticks() const;
  void restore(const std::vector<std::pair<Key, double>>& ticks);

 private:
  void schedule(std::uint32_t number);
  // The first tick whose key is not below `key`.
  Key first_tick(const CallbackRecord& callback, const Key& key) const;

  Simulation& sim_;
  std::vector<CallbackRecord> records_;
};

}  // namespace tw
