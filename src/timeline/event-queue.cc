// The event queue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/event-queue.h"

#include <algorithm>

namespace tw {

void EventQueue::settle(std::size_t at, const Slot& slot) {
  // up, while the parent is later
  const std::size_t from = at;
  while (at > 0 && before(slot, heap_[(at - 1) / 4])) {
    put(at, heap_[(at - 1) / 4]);
    at = (at - 1) / 4;
  }
  // else down, while the least child is earlier
  while (at >= from) {
    const std::size_t first = 4 * at + 1, end = std::min(first + 4, heap_.size());
    if (first >= end) break;
    std::size_t least = first;
    for (std::size_t c = first + 1; c < end; ++c)
      if (before(heap_[c], heap_[least])) least = c;
    if (!before(heap_[least], slot)) break;
    put(at, heap_[least]);
    at = least;
  }
  put(at, slot);
}

void EventQueue::schedule(Handle& handle, const Event& event) {
  if (handle != none) {
    events_[handle] = event;
    settle(place_[handle], {event.priority, handle});
    return;
  }
  if (unused_.empty()) {
    handle = static_cast<Handle>(events_.size());
    events_.push_back(event);
    place_.push_back(0);
  } else {
    handle = unused_.back();
    unused_.pop_back();
    events_[handle] = event;
  }
  heap_.emplace_back();
  settle(heap_.size() - 1, {event.priority, handle});
}

void EventQueue::withdraw(Handle& handle) {
  if (handle == none) return;
  const std::size_t at = place_[handle];
  const Slot last = heap_.back();
  heap_.pop_back();
  unused_.push_back(handle);
  handle = none;
  if (at < heap_.size()) settle(at, last);
}

void EventQueue::first_ones(std::vector<Event>& events) const {
  visit_down_from(0, [&](const Slot& slot) {
    if (slot.priority > heap_[0].priority) return false;
    events.push_back(events_[slot.handle]);
    return true;
  });
}

template <class Wanted>
double EventQueue::least_time_of(Wanted&& wanted) const {
  double least = never;
  visit_down_from(0, [&](const Slot& slot) {
    if (slot.priority >= least) return false;
    const Event& event = events_[slot.handle];
    if (wanted(event)) least = std::min(least, event.key.time);
    return true;
  });
  return least;
}

double EventQueue::least_time() const {
  return least_time_of([](const Event&) { return true; });
}

double EventQueue::least_time_but(EventKind kind) const {
  return least_time_of([kind](const Event& event) { return event.kind != kind; });
}

std::vector<EventQueue::Handle> EventQueue::handles() const {
  std::vector<Handle> all;
  for (const Slot& slot : heap_) all.push_back(slot.handle);
  return all;
}

bool EventQueue::validate() const {
  for (std::size_t i = 0; i < heap_.size(); ++i) {
    if (place_[heap_[i].handle] != i) return false;
    if (heap_[i].priority != events_[heap_[i].handle].priority) return false;
    if (i > 0 && before(heap_[i], heap_[(i - 1) / 4])) return false;
  }
  return true;
}

}  // namespace tw
