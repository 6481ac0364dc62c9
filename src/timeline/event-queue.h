// The event queue: an indexed 4-ary heap, so that an event can be moved or withdrawn in place and
// the top is never stale.  The heap holds the priorities themselves: only ties look at the events.
//
// Order: by priority (the time of the key; a head start earlier under the adversary scheduler),
// then by key.  Invariant (validate): parents are not later than children; handles point back.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "timeline/key.h"

namespace tw {

// What an event is for; `subject` numbers a body (of a group check: a member), a pair record or a
// callback.
enum class EventKind : std::uint8_t { advance, pair, callback, group_check };

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
  const Event& top() const { return events_[heap_[0].handle]; }
  double top_priority() const { return heap_[0].priority; }
  const Event& event(Handle handle) const { return events_[handle]; }
  // The first in order of the events up to a priority that are wanted; null: there is none.
  template <class Wanted>
  const Event* first_of(double latest, Wanted&& wanted) const {
    const Slot* first = nullptr;
    visit_down_from(0, [&](const Slot& slot) {
      if (slot.priority > latest) return false;
      if (first && !before(slot, *first)) return false;
      if (!wanted(events_[slot.handle])) return true;
      first = &slot;
      return false;
    });
    return first ? &events_[first->handle] : nullptr;
  }
  // Appends all events of that priority, in no order; nothing comes before.
  void first_ones(std::vector<Event>& events) const;
  // The least time of all events' keys; never before the priority of the top.  `never` if empty.
  double least_time() const;
  // The least time of the keys of all events but those of one kind; `never`: there is none.
  double least_time_but(EventKind kind) const;
  // All that are scheduled, in no order: for validators.
  std::vector<Handle> handles() const;

  // Inserts the event, or moves the one that `handle` names; updates the handle.
  void schedule(Handle& handle, const Event& event);
  // Withdraws the event, if there is one; the handle becomes `none`.
  void withdraw(Handle& handle);

  bool validate() const;

 private:
  struct Slot {
    double priority;
    Handle handle;
  };
  bool before(const Slot& a, const Slot& b) const {
    if (a.priority != b.priority) return a.priority < b.priority;
    return events_[a.handle].key < events_[b.handle].key;
  }
  // Calls visit(slot) from that place down, and below a slot only where it answers true.
  // Priorities are key times or earlier: below a slot whose priority is later than what is sought
  // there is nothing.  In order that ends at once.
  template <class Visit>
  void visit_down_from(std::size_t at, Visit&& visit) const {
    if (at >= heap_.size() || !visit(heap_[at])) return;
    for (std::size_t child = 4 * at + 1; child <= 4 * at + 4; ++child)
      visit_down_from(child, visit);
  }
  // The least time of the keys of all events that are wanted; `never`: there is none.
  template <class Wanted>
  double least_time_of(Wanted&& wanted) const;
  // Puts the slot where it belongs, from place `at` on, which is free.
  void settle(std::size_t at, const Slot& slot);
  void put(std::size_t at, const Slot& slot) {
    heap_[at] = slot;
    place_[slot.handle] = static_cast<std::uint32_t>(at);
  }

  std::vector<Event> events_;         // by handle
  std::vector<std::uint32_t> place_;  // handle -> index in heap_
  std::vector<Slot> heap_;
  std::vector<Handle> unused_;
};

}  // namespace tw
