// Checkpoints: the committed present of a world, to come back to.
//
// What is committed is the present, a state per body, with what edits have added to it, and the
// next tick per callback; everything else (claims, pairs, events) is found anew, as after any
// change.  So a run that goes on from a restored checkpoint commits the same history, bit for bit,
// as one that was never interrupted.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/checkpoint.h"

#include "kernel/kernel.h"
#include "kernel/run-guard.h"

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
  result->contact_rules = simulation.scene.contacts.version();
  for (const Process& process : simulation.processes)
    result->states.push_back(kept_states(simulation.graph, process.id, simulation.present.key()));
  result->callbacks = callbacks.committed_ticks();
  return result;
}

void Kernel::restore(const Checkpoint& checkpoint) {
  simulation.require_between_runs("a checkpoint was restored");
  Present& present = simulation.present;
  TW_REQUIRE(checkpoint.owner == this, "the checkpoint belongs to another world");
  TW_REQUIRE(
      checkpoint.states.size() == simulation.processes.size() &&
          checkpoint.callbacks.size() == callbacks.size() &&
          checkpoint.present.removals == present.removals,
      "bodies or callbacks were added or removed since the checkpoint; expected the same ones");

  // empty the graph and the event queue
  pairs.drop_all();
  for (const Process& process : simulation.processes) {
    claims.withdraw(process.id);
    simulation.graph.clear(process.id);
  }
  discontinuities.forget_undone();

  // the committed present
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
    if (present.begun) claims.schedule(process.id);
  }
  callbacks.restore(checkpoint.callbacks);
  delivery.restart();
  // groups hold the contact parameters they were made with; what rests would keep them for good
  if (present.begun && checkpoint.contact_rules != simulation.scene.contacts.version())
    editing.renew_groups();
}

}  // namespace tw
