// Callbacks: when they run, what they see, and what remains of them in the graph.
//
// Every target gets a state of the callback's key, all in one ring, also those that were only read:
// a *record* that carries the old arc along where the motion did not change.  So a callback runs
// again exactly when one of its targets is rolled back below it.  Ticks are start + k period (one
// product, one sum); without a period the next time lives in the record.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {

// The first tick whose key is not below `key`.
Key Kernel::first_tick(const CallbackRecord& callback, const Key& key) const {
  const std::uint64_t number = static_cast<std::uint64_t>(&callback - callbacks.data());
  const auto tick = [&](double k) {
    return Key{callback.def.start + k * *callback.def.period, 0, KeyKind::callback, number};
  };
  double k = std::max(0.0, std::floor((key.time - callback.def.start) / *callback.def.period) - 1);
  while (tick(k) < key) ++k;
  return tick(k);
}

void Kernel::schedule_callback(std::uint32_t number) {
  CallbackRecord& callback = callbacks[number];
  if (callback.next.time == never || callback.parked || callback.ended) {
    queue.withdraw(callback.event);
    return;
  }
  queue.schedule(callback.event,
                 make_event(callback.next, EventKind::callback, number, callback.head_start));
}

// A target lost its states from `key` on: back to the first call that is not done any more.
void Kernel::rewind_callback(std::uint32_t number, const Key& key) {
  CallbackRecord& callback = callbacks[number];
  callback.parked = false;
  if (!(callback.next < key)) {
    if (callback.def.period) {
      callback.next = first_tick(callback, key);
    } else {
      // the last record that is left says when
      double next = callback.committed_next;
      for (const State* s = graph.tail(process_of(callback.def.targets.front())); s; s = s->prev)
        if (s->key.kind == KeyKind::callback && s->key.id == number) {
          next = s->next_callback;
          break;
        }
      callback.next = {next, 0, KeyKind::callback, number};
    }
  }
  // a call that stands is not made twice
  const State* tail =
      graph.last_at_or_before(process_of(callback.def.targets.front()), callback.next);
  if (tail && tail->key == callback.next && callback.def.period)
    callback.next = first_tick(callback, {callback.next.time, 0, KeyKind::callback, number + 1ull});
  schedule_callback(number);
}

Progress Kernel::process_callback(std::uint32_t number) {
  CallbackRecord& callback = callbacks[number];
  const Key key = callback.next;

  // only after the targets' claims have reached its time; a stopped target parks it
  for (const BodyId id : callback.def.targets)
    if (graph.tail(process_of(id))->error && graph.tail(process_of(id))->key < key) {
      callback.parked = true;
      schedule_callback(number);
      return Progress::done;
    }
  std::vector<ProcessId> struck;
  for (const BodyId id : callback.def.targets) {
    if (!await(process_of(id), key)) return Progress::try_again;
    if (scene.body(id).dynamic()) insert(struck, process_of(id));
  }
  if (!await(region_of(before(key), struck, false), key)) return Progress::try_again;
  if (!(callback.next == key)) return Progress::try_again;

  // drafts that carry the old arcs, and views of them
  std::vector<Successor> successors;
  for (const BodyId id : callback.def.targets)
    successors.push_back(make_successor(before(key), process_of(id), false));
  std::vector<std::pair<SlotsPtr, std::uint64_t>> before;
  for (Successor& successor : successors) {
    successor.role = Role::record;
    before.push_back({successor.data.slots, successor.data.random});
  }
  std::vector<SuccessorView> views;
  views.reserve(successors.size());
  for (Successor& successor : successors)
    views.emplace_back(successor, key, false, present.settings.gravity);
  std::vector<StateView*> pointers;
  for (SuccessorView& view : views) pointers.push_back(&view);

  // the call; its error stops the targets, speculatively
  double next = never;
  ++present.counters.callbacks_run;
  try {
    const auto answer = callback.def.callback->run(key.time, pointers);
    if (!callback.def.period && answer) {
      if (!(*answer > key.time))
        throw UserError("callback " + callback.def.name + " at " + show(key.time) +
                            " s returned the next time " + show(*answer) +
                            "; expected a later time or #f",
                        callback.def.place);
      // only now: a queue holds no time that is past or not a number
      next = *answer;
    }
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    for (Successor& successor : successors) successor.data.error = std::current_exception();
  }

  bool any_changed = false;
  for (std::size_t i = 0; i < successors.size(); ++i) {
    StateData& data = successors[i].data;
    any_changed = any_changed || successors[i].starts_arc() || data.slots != before[i].first ||
                  data.random != before[i].second;
    data.next_callback = next;
  }
  for (Successor& successor : successors) successor.data.changed = any_changed;
  if (successors.front().data.error)
    stop_group_mates(key, successors);
  else if (touches_groups(successors) &&
           regroup(key, successors, Cause::callback) == Progress::try_again)
    return Progress::try_again;

  // the next call, then the states (a rollback through them rewinds it again)
  callback.next = callback.def.period
                      ? first_tick(callback, {key.time, 0, KeyKind::callback, number + 1ull})
                      : Key{next, 0, KeyKind::callback, number};
  schedule_callback(number);
  enter_discontinuity(key, successors);
  return Progress::done;
}

}  // namespace tw
