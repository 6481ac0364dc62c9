// Checkpoints: the committed present of a world, to come back to.
//
// What is committed is the present, a state per body, with what edits have added to it, and the
// next tick per callback; everything else (claims, pairs, events) is found anew, as after any
// change.  So a run that goes on from a restored checkpoint commits the same history, bit for bit,
// as one that was never interrupted.
//
// Who was there is part of it: bodies and multibodies, rules of contact, callbacks, observers.
// What came since is gone, what was removed is back.  They are shared, and one that a checkpoint
// knows never changes but by lists that are made anew (bodies.cc); so any checkpoint of a world may
// be restored after any other.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/checkpoint.h"

#include "kernel/loop/kernel.h"
#include "kernel/loop/run-guard.h"

namespace tw {
namespace {

// Of a process, up to a key: the last committed state, and what edits have added to it.
std::vector<Checkpoint::Kept> kept_states(const StateGraph& graph, ProcessId process,
                                          const Key& end) {
  const State* state = graph.last_before(process, end);
  while (state->prev && !state->committed) state = state->prev;
  std::vector<Checkpoint::Kept> kept;
  for (; state && state->key < end; state = state->next)
    kept.push_back({state->key, state->committed, *state});
  return kept;
}

}  // namespace

std::shared_ptr<const Checkpoint> Kernel::checkpoint() {
  simulation.require_between_runs("a checkpoint was made");
  // what an interrupt or an observer's error has left undelivered belongs to the time before
  {
    const RunGuard guard(simulation);
    delivery.deliver(never);
  }
  auto result = std::make_shared<Checkpoint>();
  result->owner = this;
  result->present = simulation.present;
  result->bodies = bodies.keep();
  for (const Process& process : simulation.processes)
    result->states.push_back(kept_states(simulation.graph, process.id, simulation.present.key()));
  result->callbacks = callbacks.keep();
  result->collision_callbacks = impacts.callbacks();
  result->watchers = delivery.keep();
  return result;
}

void Kernel::restore(const Checkpoint& checkpoint) {
  simulation.require_between_runs("a checkpoint was restored");
  Present& present = simulation.present;
  TW_REQUIRE(checkpoint.owner == this, "the checkpoint belongs to another world");
  // empty the graph and the event queue
  pairs.drop_all();
  for (const Process& process : simulation.processes) {
    claims.withdraw(process.id);
    simulation.graph.clear(process.id);
  }
  discontinuities.forget_undone();

  // the committed present
  bodies.restore(checkpoint.bodies);
  present = checkpoint.present;
  simulation.scale_joints();
  for (Process& process : simulation.processes) {
    for (const Checkpoint::Kept& kept : checkpoint.states[number(process.id)]) {
      State* state = simulation.graph.append(process.id, kept.key);
      static_cast<StateData&>(*state) = kept.data;
      state->committed = kept.committed;
    }
  }

  // the future: boxes are those of another time until the first claim
  for (Process& process : simulation.processes) {
    const Body& body = simulation.body_of(process.id);
    const Key first = simulation.graph.head(process.id)->key;
    process.claim = !present.begun ? first : body.fixed() ? last_key : present.key();
    process.lonely_claims = 0;
    if (!body.fixed())
      for (const BodyId id : process.bodies) claims.forget_box(id);
    // before the first run only what was edited has events
    if (present.begun || is_edit(simulation.graph.tail(process.id)->key))
      claims.schedule(process.id);
  }
  if (present.begun) bodies.place_fixed();
  callbacks.restore(checkpoint.callbacks);
  impacts.restore(checkpoint.collision_callbacks);
  delivery.restore(checkpoint.watchers);
  delivery.restart();
}

}  // namespace tw
