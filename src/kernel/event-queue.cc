// The event queue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/event-queue.h"

#include <algorithm>

namespace tw {

bool EventQueue::before(Handle a, Handle b) const {
  const Event& x = events_[a];
  const Event& y = events_[b];
  if (x.priority != y.priority) return x.priority < y.priority;
  return x.key < y.key;
}

void EventQueue::put(std::size_t at, Handle handle) {
  heap_[at] = handle;
  place_[handle] = static_cast<std::uint32_t>(at);
}

void EventQueue::up(std::size_t at) {
  const Handle moving = heap_[at];
  while (at > 0) {
    const std::size_t parent = (at - 1) / 4;
    if (!before(moving, heap_[parent])) break;
    put(at, heap_[parent]);
    at = parent;
  }
  put(at, moving);
}

void EventQueue::down(std::size_t at) {
  const Handle moving = heap_[at];
  for (;;) {
    const std::size_t first = 4 * at + 1;
    if (first >= heap_.size()) break;
    std::size_t least = first;
    for (std::size_t c = first + 1; c < std::min(first + 4, heap_.size()); ++c)
      if (before(heap_[c], heap_[least])) least = c;
    if (!before(heap_[least], moving)) break;
    put(at, heap_[least]);
    at = least;
  }
  put(at, moving);
}

void EventQueue::schedule(Handle& handle, const Event& event) {
  if (handle != none) {
    events_[handle] = event;
    const std::size_t at = place_[handle];
    up(at);
    down(place_[handle]);
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
  heap_.push_back(handle);
  place_[handle] = static_cast<std::uint32_t>(heap_.size() - 1);
  up(heap_.size() - 1);
}

void EventQueue::withdraw(Handle& handle) {
  if (handle == none) return;
  const std::size_t at = place_[handle];
  const Handle last = heap_.back();
  heap_.pop_back();
  unused_.push_back(handle);
  handle = none;
  if (at == heap_.size()) return;
  put(at, last);
  up(at);
  down(place_[last]);
}

bool EventQueue::validate() const {
  for (std::size_t i = 0; i < heap_.size(); ++i) {
    if (place_[heap_[i]] != i) return false;
    if (i > 0 && before(heap_[i], heap_[(i - 1) / 4])) return false;
  }
  return true;
}

}  // namespace tw
