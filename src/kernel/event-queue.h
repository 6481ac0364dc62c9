// The event queue: an indexed 4-ary heap, so that an event can be moved or withdrawn in place and
// the top is never stale.
//
// Order: by priority (the time of the key; a head start earlier under the adversary scheduler), then
// by key.  Invariant (validate): parents are not later than children; handles point back.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/key.h"

namespace tw {

// What an event is for; `subject` numbers a body, a pair record or a callback.
enum class EventKind : std::uint8_t { advance, pair, callback };

struct Event {
  double priority = 0;
  Key key;
  EventKind kind = EventKind::advance;
  std::uint32_t subject = 0;
};

class EventQueue {
 public:
  using Handle = std::uint32_t;
  static constexpr Handle none = 0xffffffffu;

  bool empty() const { return heap_.empty(); }
  std::size_t size() const { return heap_.size(); }
  const Event& top() const { return events_[heap_[0]]; }
  const Event& event(Handle handle) const { return events_[handle]; }
  const std::vector<Handle>& handles() const { return heap_; }

  // Inserts the event, or moves the one that `handle` names; updates the handle.
  void schedule(Handle& handle, const Event& event);
  // Withdraws the event, if there is one; the handle becomes `none`.
  void withdraw(Handle& handle);

  bool validate() const;

 private:
  bool before(Handle a, Handle b) const;
  void up(std::size_t at);
  void down(std::size_t at);
  void put(std::size_t at, Handle handle);

  std::vector<Event> events_;        // by handle
  std::vector<std::uint32_t> place_; // handle -> index in heap_
  std::vector<Handle> heap_;
  std::vector<Handle> unused_;
};

}  // namespace tw
