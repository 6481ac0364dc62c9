// Checkpoints: the committed present of a world, to come back to.
//
// What is committed is a state per body, with what edits have added to it, and the next tick per
// callback; everything else (claims, pairs, events) is found anew, as after any change.  So a run
// that goes on from a restored checkpoint commits the same history, bit for bit, as one that was
// never interrupted.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/checkpoint.h"

#include "kernel/kernel.h"

namespace tw {

std::shared_ptr<const Checkpoint> Kernel::checkpoint() {
  require_between_runs("a checkpoint was made");
  // what an interrupt or an observer's error has left undelivered belongs to the time before
  deliver_rest();
  auto result = std::make_shared<Checkpoint>();
  result->owner = this;
  result->present = present;
  const Key now = present.key();
  for (const auto& body : scene.bodies) {
    const State* state = graph.last_before(body->process, now);
    while (state->prev && !state->committed) state = state->prev;
    auto& kept = result->states.emplace_back();
    for (; state && state->key < now; state = state->next)
      kept.push_back({state->key, state->committed, *state});
  }
  for (const CallbackRecord& callback : callbacks) {
    // the first call that is not committed
    Key next{callback.committed_next, 0, KeyKind::callback,
             static_cast<std::uint64_t>(&callback - callbacks.data())};
    if (callback.def.period)
      next = first_tick(callback, !present.begun ? Key{}
                                  : present.due.inclusive
                                      ? Key{present.time, 0, KeyKind::group_check, 0}
                                      : now);
    result->callbacks.push_back({next, callback.committed_next});
  }
  return result;
}

void Kernel::restore(const Checkpoint& checkpoint) {
  require_between_runs("a checkpoint was restored");
  TW_REQUIRE(checkpoint.owner == this, "the checkpoint belongs to another world");
  TW_REQUIRE(
      checkpoint.states.size() == scene.bodies.size() &&
          checkpoint.callbacks.size() == callbacks.size() &&
          checkpoint.present.removals == present.removals,
      "bodies or callbacks were added or removed since the checkpoint; expected the same ones");

  // empty the graph and the event queue
  for (std::uint32_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].live) drop_pair(i);
  for (const auto& body : scene.bodies) {
    queue.withdraw(process(*body).advance);
    queue.withdraw(process(*body).group_check);
    graph.clear(body->process);
  }
  undelivered_.clear();
  next_observer_ = 0;
  undone_.clear();

  // the committed present
  present = checkpoint.present;
  const Key now = present.key();
  newborn_.clear();
  for (const auto& body : scene.bodies) {
    for (const Checkpoint::Kept& kept : checkpoint.states[body->id()]) {
      State* state = graph.append(body->process, kept.key);
      static_cast<StateData&>(*state) = kept.data;
      state->committed = kept.committed;
    }
    const Key first = graph.head(body->process)->key;
    process(*body).claim = body->fixed() && present.begun ? last_key : present.begun ? now : first;
    process(*body).lonely_claims = 0;
    // boxes are those of another time until the first claim
    if (!body->fixed()) body->placed = false;
    if (present.begun) {
      schedule_advance(*body);
      schedule_group_check(body->process);
    } else {
      newborn_.push_back(body->id());
    }
  }
  for (std::uint32_t i = 0; i < callbacks.size(); ++i) {
    callbacks[i].next = checkpoint.callbacks[i].first;
    callbacks[i].committed_next = checkpoint.callbacks[i].second;
    callbacks[i].parked = false;
    schedule_callback(i);
  }
  // frames go on with the first that had not been delivered
  for (SinkRecord& sink : sinks) {
    sink.next_frame = 0;
    while (present.due.reaches(sink.next_time())) ++sink.next_frame;
  }
}

}  // namespace tw
