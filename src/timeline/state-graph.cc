// The state graph.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "timeline/state-graph.h"

#include <algorithm>

#include "base/error.h"

namespace tw {

ProcessId StateGraph::add_process() {
  queues_.push_back({});
  return static_cast<ProcessId>(queues_.size() - 1);
}

void StateGraph::set_process_count(std::size_t count) {
  TW_ASSERT(live_ == 0, "queues are not empty");
  queues_.clear();
  queues_.resize(count);
  busy_.clear();
}

State* StateGraph::allocate() {
  State* state = nullptr;
  if (unused_.empty()) {
    state = &pool_.emplace_back();
  } else {
    state = unused_.back();
    unused_.pop_back();
  }
  peak_ = std::max(peak_, ++live_);
  return state;
}

void StateGraph::release(State* state) {
  *state = State();
  state->ring = state->ring_before = state;
  unused_.push_back(state);
  --live_;
}

State* StateGraph::append(ProcessId process, const Key& key) {
  Queue& queue = queues_[number(process)];
  State* const before = queue.tail.get();
  TW_ASSERT(!before || before->key < key, "keys in the queue of " + show(process) +
                                              " must increase: " + show(key) + " after " +
                                              show(before->key));
  State* state = allocate();
  state->key = key;
  state->process = process;
  state->entered = ++entered_;
  state->ring = state->ring_before = state;
  state->prev = before;
  (before ? before->next : queue.head) = state;
  queue.tail.set(state);
  if (!queue.busy) busy_.push_back(process);
  queue.busy = true;
  return state;
}

void StateGraph::tidy_busy() {
  std::erase_if(busy_, [&](ProcessId process) {
    Queue& queue = queues_[number(process)];
    const State* const tail = queue.tail.get();
    queue.busy = tail && (queue.head != tail || !tail->committed);
    return !queue.busy;
  });
}

void StateGraph::close_ring(std::span<State* const> states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    State* const after = states[(i + 1) % states.size()];
    states[i]->ring = after;
    after->ring_before = states[i];
  }
}

State* StateGraph::last_at_or_before(ProcessId process, const Key& key) const {
  State* state = tail(process);
  while (state && state->key > key) state = state->prev;
  return state;
}

State* StateGraph::last_before(ProcessId process, const Key& key, std::uint64_t entered) const {
  State* state = tail(process);
  while (state && (state->entered > entered || state->key >= key)) state = state->prev;
  return state;
}

State* StateGraph::last_at_or_before_time(ProcessId process, double time) const {
  State* state = tail(process);
  while (state && state->key.time > time) state = state->prev;
  return state;
}

void StateGraph::leave_ring(State* state) {
  state->ring_before->ring = state->ring;
  state->ring->ring_before = state->ring_before;
  state->ring = state->ring_before = state;
}

std::size_t StateGraph::rollback(ProcessId process, const Key& key, std::vector<Affected>& affected,
                                 const OnRelease& on_release) {
  struct Work {
    ProcessId process;
    Key key;
  };
  if (const State* last = tail(process); !last || last->key < key) return 0;
  before_removal_();
  std::vector<Work> work{{process, key}};
  std::size_t removed = 0;

  while (!work.empty()) {
    const Work item = work.back();
    work.pop_back();
    Queue& queue = queues_[number(item.process)];
    Key least = last_key;

    // newest first
    while (State* const state = queue.tail.get()) {
      if (state->key < item.key) break;
      TW_ASSERT(!state->committed, "rollback of " + show(item.process) + " to " + show(item.key) +
                                       " reached the committed " + show(state->key));
      // all of its ring go with it
      while (state->ring != state) {
        State* const other = state->ring;
        work.push_back({other->process, other->key});
        leave_ring(other);
      }
      least = state->key;
      queue.tail.set(state->prev);
      (state->prev ? state->prev->next : queue.head) = nullptr;
      on_release(*state);
      release(state);
      ++removed;
    }

    if (least == last_key) continue;
    const auto known = std::find_if(affected.begin(), affected.end(),
                                    [&](const Affected& t) { return t.process == item.process; });
    if (known == affected.end())
      affected.push_back({item.process, least});
    else
      known->least_removed = std::min(known->least_removed, least);
  }
  return removed;
}

void StateGraph::free_before(State* keep, const OnRelease& on_release) {
  Queue& queue = queues_[number(keep->process)];
  if (queue.head != keep) before_removal_();
  while (queue.head != keep) {
    State* state = queue.head;
    leave_ring(state);
    queue.head = state->next;
    queue.head->prev = nullptr;
    on_release(*state);
    release(state);
  }
}

void StateGraph::clear(ProcessId process) {
  before_removal_();
  Queue& queue = queues_[number(process)];
  while (queue.head) {
    State* state = queue.head;
    leave_ring(state);
    queue.head = state->next;
    release(state);
  }
  queue.tail.set(nullptr);
}

std::string StateGraph::validate() const {
  std::size_t found = 0;
  for (std::uint32_t p = 0; p < queues_.size(); ++p) {
    const State* before = nullptr;
    const Queue& queue = queues_[p];
    const State* const tail = queue.tail.get();
    if (tail && !queue.busy && (queue.head != tail || !tail->committed))
      return "not listed as busy: " + show(ProcessId{p});
    for (const State* s = queue.head; s; before = s, s = s->next, ++found) {
      const std::string where = show(ProcessId{p}) + ", " + show(s->key);
      if (s->process != ProcessId{p}) return "state in a foreign queue: " + where;
      if (s->prev != before) return "broken link: " + where;
      if (before && !(before->key < s->key)) return "keys do not increase: " + where;
      if (before && s->committed && !before->committed) return "commit out of order: " + where;
      std::size_t length = 0;
      const State* r = s;
      do {
        if (r->ring->ring_before != r) return "ring broken backwards: " + where;
        if (r->key != s->key) return "ring of two keys: " + where;
        if (++length > queues_.size()) return "ring does not close: " + where;
        if (r != s && r->process == s->process) return "ring meets a queue twice: " + where;
        r = r->ring;
      } while (r != s);
    }
    if (tail != before) return "wrong tail: " + show(ProcessId{p});
  }
  if (found != live_) return "states outside of all queues";
  return "";
}

}  // namespace tw
