// The state graph: all state queues, the rings between them, and rollback over both.
//
// Invariants (validate_state_graph): keys in a queue strictly increase; links are mutual; rings are
// closed, hold one key and at most one state a queue.
// Cost: appending, removing and freeing a state are O(1); memory comes from a pool.
// Source: the paper, sections 4.2 and figure 3; rings and keys: doc/architecture.md.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "timeline/state.h"

namespace tw {

// A process that lost states to a rollback, with the least key it lost.
struct Affected {
  ProcessId process{};
  Key least_removed;
};

class StateGraph {
 public:
  // What happens to a state just before it goes: statistics, slot storage.
  using OnRelease = std::function<void(State&)>;

  ProcessId add_process();
  // So many from here on; all queues must be empty.
  void set_process_count(std::size_t count);
  std::size_t process_count() const { return queues_.size(); }
  State* head(ProcessId process) const { return queues_[number(process)].head; }
  State* tail(ProcessId process) const { return queues_[number(process)].tail.get(); }

  static constexpr std::uint64_t all_states = ~std::uint64_t{0};
  // How many states have entered so far, those that are gone again included.
  std::uint64_t entered() const { return entered_; }
  // While states enter others may look at those that entered before.  Called before any state goes:
  // waits until nobody looks.
  void before_removal(std::function<void()> wait) { before_removal_ = std::move(wait); }

  // Appends a fresh state with `key` to the queue.  The key must be later than the tail's.
  State* append(ProcessId process, const Key& key);
  // Closes the states of one discontinuity into a ring.
  void close_ring(std::span<State* const> states);

  // The last state with key <= `key` (or < it); null if there is none.
  State* last_at_or_before(ProcessId process, const Key& key) const;
  // Of the first `entered` states alone.
  State* last_before(ProcessId process, const Key& key, std::uint64_t entered = all_states) const;
  // The last state with time <= `time`; null if there is none.
  State* last_at_or_before_time(ProcessId process, double time) const;

  // Removes from `process` every state with key >= `key`, and through rings whatever they touched:
  // nothing else.  A work list, not the call stack.  Adds to `touched` each process that lost a
  // state, with its least lost key (once a process).  A committed state is never touched:
  // assertion. Returns the number of states removed.
  std::size_t rollback(ProcessId process, const Key& key, std::vector<Affected>& affected,
                       const OnRelease& on_release);

  // Frees the states before `keep` in its queue: they are final and nobody will ask again.  A freed
  // state leaves its ring; rings of committed states need no partners.
  void free_before(State* keep, const OnRelease& on_release);

  // Removes every state of the queue, committed ones too: for restoring a checkpoint.
  void clear(ProcessId process);

  // The processes that have more than one state or one that is not committed, each once, in no
  // order: whom commit must look at.  May name others too, until the next tidy_busy().
  const std::vector<ProcessId>& busy() const { return busy_; }
  void tidy_busy();

  std::size_t state_count() const { return live_; }
  std::size_t peak_state_count() const { return peak_; }

  // Empty if every invariant holds, else the first that does not.
  std::string validate() const;

 private:
  // The end of a queue; who sees a state there sees its key and what it follows.
  class Tail {
   public:
    Tail() = default;
    Tail(const Tail& other) : state_(other.get()) {}
    Tail& operator=(const Tail&) = delete;
    State* get() const { return state_.load(std::memory_order_acquire); }
    void set(State* state) { state_.store(state, std::memory_order_release); }

   private:
    std::atomic<State*> state_{nullptr};
  };
  struct Queue {
    State* head = nullptr;
    Tail tail;
    bool busy = false;  // stands in busy_
  };
  State* allocate();
  void release(State* state);
  void leave_ring(State* state);

  std::vector<Queue> queues_;
  std::vector<ProcessId> busy_;
  std::deque<State> pool_;  // addresses stay
  std::vector<State*> unused_;
  std::size_t live_ = 0, peak_ = 0;
  std::uint64_t entered_ = 0;
  std::function<void()> before_removal_ = [] {};
};

}  // namespace tw
