// Entering a discontinuity: rollback of its receivers, their new states, and what follows for
// claims and events.
//
// First all queues, then all claims, then all events: queues are wholly changed before any pair is
// looked at again.  Treated are the receivers (even where they lost nothing) and every process that
// lost a state, each from the least key it lost (doc/architecture.md, "Rollback").
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {

// The state of `body` just below `key`, evaluated at its time: with a new arc or carrying the old.
Successor Kernel::make_successor(const Body& body, const Key& key, bool new_arc) const {
  const State* state = graph.last_before(body.process, key);
  TW_ASSERT(state, "no state of " + body.info.name + " before " + show(key));
  Successor successor;
  successor.body = &body;
  successor.point = state->trajectory().at(key.time);
  successor.data = *state;
  successor.data.changed = true;
  successor.data.next_callback = never;
  successor.data.report.reset();
  successor.data.tally = {};
  successor.data.error = nullptr;
  successor.role = body.dynamic() || successor.data.slots ? Role::record : Role::no_state;
  if (new_arc) start_new_arc(successor, key);
  return successor;
}

// A motion that is not finite, or runs away, becomes a speculative error of its body.
void Kernel::check_finite(Successor& successor) const {
  const StateData& d = successor.data;
  if (!successor.body->dynamic() || d.error) return;
  const bool finite = is_finite(d.x) && is_finite(d.q) && is_finite(d.v) && is_finite(d.L);
  if (finite && d.v.norm() <= speed_limit) return;
  const std::string name = successor.body->info.name, when = show(d.arc_time);
  const std::string message = finite ? "the speed of " + name + " at " + when + " s is " +
                                           show(d.v.norm()) + " m/s; expected at most " +
                                           show(speed_limit)
                                     : "the motion of " + name + " is no longer finite at " + when +
                                           " s; expected finite positions and velocities";
  successor.data.error = std::make_exception_ptr(UserError(message, successor.body->info.place));
}

// An error stops whole groups: adds the fellows of the drafts, and gives all the first one's error.
void Kernel::stop_group_mates(const Key& key, std::vector<Successor>& successors) const {
  const std::exception_ptr error = successors.front().data.error;
  std::vector<BodyId> ids;
  for (const Successor& successor : successors)
    if (successor.body->dynamic()) ids.push_back(successor.body->id());
  std::sort(ids.begin(), ids.end());
  const Region region = region_of(key, ids, true);
  for (const std::vector<BodyId>* side : {&region.inside, &region.border})
    for (const BodyId id : *side)
      if (std::none_of(successors.begin(), successors.end(),
                       [&](const Successor& d) { return d.body->id() == id; }))
        successors.push_back(make_successor(*bodies[id], key, false));
  for (Successor& successor : successors) successor.data.error = error;
}

// The drafts give their slots, collisions and errors away.
void Kernel::append_successors(const Key& key, std::vector<Successor>& successors) {
  for (Successor& successor : successors) check_finite(successor);
  const auto stopped = std::find_if(successors.begin(), successors.end(),
                                    [](const Successor& d) { return d.data.error != nullptr; });
  if (stopped != successors.end()) {
    const std::exception_ptr error = stopped->data.error;
    for (Successor& successor : successors) successor.data.error = error;
  }
  std::vector<State*> ring;
  for (Successor& successor : successors) {
    // a fixed body without states does not stop: its partner in the impact does
    if (!successor.enters()) continue;
    // the process stops here: its arcs end
    if (successor.data.error) {
      successor.data.arc_key = key;
      successor.role = Role::new_arc;
    }
    const bool flies = successor.starts_arc() && successor.body->dynamic() && !successor.data.group;
    if (flies) let_fly(*successor.body, successor.data);
    State* state = graph.append(successor.process(), key);
    static_cast<StateData&>(*state) = std::move(successor.data);
    ring.push_back(state);
    if (!state->starts_arc() || !successor.body->dynamic()) continue;
    TW_ASSERT(!state->group || state->group->key == key || state->error,
              "state of " + successor.body->info.name + " at " + show(key) + " in an older group");
    // those of moving groups are counted by steps, when they are done with
    if (!state->trajectory().stepped()) ++counters.integrations;
  }
  graph.close_ring(ring);
}

void Kernel::enter_discontinuity(const Key& key, std::vector<Successor>& successors) {
  TW_ASSERT(key.time >= gvt, show(key) + " lies before GVT " + show(gvt));
  const std::uint64_t checksum = options.undo_redo ? graph_checksum() : 0;

  // queues: room for the new states, then the states
  std::vector<Affected> affected;
  std::size_t removed = 0;
  for (const Successor& successor : successors)
    if (successor.enters())
      removed += graph.rollback(successor.body->process, key, affected, removal());
  if (removed > 0) {
    ++counters.rollbacks;
    counters.states_removed += removed;
    counters.processes_rolled_back += affected.size();
    counters.deepest_cascade = std::max<std::uint64_t>(counters.deepest_cascade, affected.size());
  }
  append_successors(key, successors);

  // receivers are treated from `key` where their arc changed, others from the least key lost
  for (const Successor& successor : successors) {
    const bool arc_changed = successor.role == Role::new_arc;
    const auto known = std::find_if(affected.begin(), affected.end(), [&](const Affected& t) {
      return t.process == successor.process();
    });
    if (known != affected.end())
      known->least_removed = std::min(known->least_removed, key);
    else if (arc_changed)
      affected.push_back({successor.process(), key});
  }
  treat(affected);
  if (options.undo_redo && removed == 0) undo_and_check(key, checksum);
}

void Kernel::treat(const std::vector<Affected>& affected) {
  // claims
  for (const Affected& t : affected) {
    Body& body = body_of(t.process);
    if (body.fixed()) continue;
    process(body).claim = std::min(process(body).claim, t.least_removed);
    schedule_advance(body);
    schedule_group_check(body);
  }
  // events: pairs and callbacks
  for (const Affected& t : affected) {
    Body& body = body_of(t.process);
    for (const std::uint32_t index : body.pairs) reset_pair(index, t.least_removed);
    for (const std::uint32_t number : process(body).callbacks)
      rewind_callback(number, t.least_removed);
  }
}

StateGraph::OnRelease Kernel::removal() {
  return [this](State& state) { note_removed(state); };
}

namespace {

// A stepped arc counts as far as it was computed, and every step as an integration.
double count_steps(Counters& counters, const Trajectory& trajectory) {
  const Effort effort = trajectory.effort();
  counters.integrations += effort.steps;
  counters.implicit_steps += effort.steps;
  counters.rejected_steps += effort.rejected;
  counters.factorizations += effort.factorizations;
  counters.force_evaluations += effort.evaluations;
  return effort.length;
}

}  // namespace

// A discarded arc counts up to its claimed time.
void Kernel::note_removed(State& state) {
  const Body& body = body_of(state.process);
  if (!body.dynamic() || !state.starts_arc()) return;
  const double end = std::min(process(body).claim.time, state.next ? state.next->key.time : never);
  double length = std::max(0.0, end - state.key.time);
  // a body at rest claims for ever
  if (!std::isfinite(length)) length = 0;
  if (state.trajectory().stepped()) length = count_steps(counters, state.trajectory());
  counters.integration_length += length;
  counters.rollback_length += length;
  counters.deepest_rollback = std::max(counters.deepest_rollback, length);
}

// A state that GVT has passed: its arc was used up to the next one.
StateGraph::OnRelease Kernel::release() {
  return [this](State& state) {
    if (!body_of(state.process).dynamic() || !state.starts_arc()) return;
    const State* next = state.next;
    while (next && !next->starts_arc()) next = next->next;
    if (next) counters.kinematic_work += contact_work(state, next->key.time);
    if (state.trajectory().stepped())
      counters.integration_length += count_steps(counters, state.trajectory());
    else if (next)
      counters.integration_length += next->key.time - state.key.time;
  };
}

// Test mode: takes the discontinuity just entered back, compares every queue with what it was, and
// lets it be found again; the second time its states must be what they were the first.
void Kernel::undo_and_check(const Key& key, std::uint64_t checksum_before) {
  Hasher name;
  name.add(key.time);
  name.add(std::uint64_t{key.microstep});
  name.add(static_cast<std::uint64_t>(key.kind));
  name.add(key.id);
  // redone is what follows the same states: another history may have an impact at the same time
  for (const auto& body : bodies)
    if (const State* s = graph.tail(body->process); s->key == key && s->prev)
      name.add(state_checksum(*s->prev));
  const std::uint64_t now = ring_checksum(key);
  if (const auto known = undone_.find(name.value()); known != undone_.end()) {
    TW_ASSERT(known->second == now, "redoing " + show(key) + " gave other states");
    undone_.erase(known);
    return;
  }

  std::vector<Affected> affected;
  for (const auto& body : bodies)
    if (graph.tail(body->process)->key == key) {
      graph.rollback(body->process, key, affected, removal());
      break;
    }
  TW_ASSERT(graph_checksum() == checksum_before, "undoing " + show(key) + " left a trace");
  undone_[name.value()] = now;
  treat(affected);
}

}  // namespace tw
