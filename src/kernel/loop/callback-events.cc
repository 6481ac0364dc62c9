// What the loop does for callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/callback-events.h"

#include "groups/joints/joints.h"
#include "groups/regroup/regroup.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/group-events.h"
#include "kernel/loop/simulation.h"

namespace tw {

CallbackEvents::CallbackEvents(Simulation& simulation, CallbackBook& book,
                               Discontinuities& discontinuities, GroupEvents& groups)
    : sim_(simulation),
      counters_(simulation.present.counters),
      book_(book),
      discontinuities_(discontinuities),
      groups_(groups) {}

Progress CallbackEvents::process(std::uint32_t number) {
  const CallbackRecord& callback = book_[number];
  const Key key = callback.next;

  // only after the targets' claims have reached its time; a stopped target parks it
  for (const BodyId id : callback.def.targets)
    if (const State& tail = *sim_.graph.tail(sim_.process_of(id)); tail.error && tail.key < key) {
      book_.park(number);
      return Progress::done;
    }
  if (!groups_.await_struck(callback.def.targets, key)) return Progress::try_again;
  if (!(callback.next == key)) return Progress::try_again;

  // successors that carry the old arcs, and views of them
  const Before before = sim_.before(key);
  const Scratch::Use use(scratch_);
  auto& [successors, views, pointers] = scratch_;
  successors.reserve(callback.def.targets.size());
  for (const BodyId id : callback.def.targets)
    successors.push_back(make_successor(before, sim_.process_of(id), false));
  share_joints(successors);
  views.reserve(successors.size());
  pointers.reserve(successors.size());
  for (Successor& successor : successors) {
    successor.role = Role::record;
    pointers.push_back(
        &views.emplace_back(sim_.scene, before.state(successor.process()), successor, key, false));
  }

  // the call; its error stops the targets, speculatively
  double next = never;
  ++counters_.callbacks_run;
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
    const State& was = before.state(successors[i].process());
    any_changed = any_changed || successors[i].starts_arc() || data.slots != was.slots ||
                  data.random != was.random;
    data.next_callback = next;
  }
  for (Successor& successor : successors) successor.data.changed = any_changed;
  if (successors.front().data.error)
    discontinuities_.stop_group_mates(before, successors);
  else if (touches_groups(successors) &&
           groups_.regroup(key, successors, Cause::callback) == Progress::try_again)
    return Progress::try_again;

  // the next call, then the states (a rollback through them rewinds it again)
  book_.move_on(number, next);
  discontinuities_.enter(key, successors);
  return Progress::done;
}

}  // namespace tw
