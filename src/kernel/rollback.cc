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
  std::vector<ProcessId> stopped;
  for (const Successor& successor : successors)
    if (successor.body->dynamic()) insert(stopped, successor.process());
  const Region region = region_of(before(key), stopped, true);
  for (const std::vector<ProcessId>* part : {&region.inside, &region.border})
    for (const ProcessId process : *part)
      if (std::none_of(successors.begin(), successors.end(),
                       [&](const Successor& s) { return s.process() == process; }))
        successors.push_back(make_successor(before(key), process, false));
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
    State* state = graph.append(successor.process(), key);
    static_cast<StateData&>(*state) = std::move(successor.data);
    ring.push_back(state);
    if (!state->starts_arc() || !successor.body->dynamic()) continue;
    TW_ASSERT(!state->group || state->group->key == key || state->error,
              "state of " + successor.body->info.name + " at " + show(key) + " in an older group");
    // those of moving groups are counted by steps, when they are done with
    if (!state->group || state->group->at_rest) ++present.counters.integrations;
  }
  graph.close_ring(ring);
}

void Kernel::enter_discontinuity(const Key& key, std::vector<Successor>& successors) {
  TW_ASSERT(key.time >= present.gvt, show(key) + " lies before GVT " + show(present.gvt));
  const std::uint64_t checksum = options.undo_redo ? graph_checksum(graph) : 0;

  // queues: room for the new states, then the states
  std::vector<Affected> affected;
  std::size_t removed = 0;
  for (const Successor& successor : successors)
    if (successor.enters())
      removed += graph.rollback(successor.body->process, key, affected, removal());
  // whom the policy adds loses nothing that is past: between runs others may have had more
  // discontinuities at the present time than those whom an edit concerns
  RollbackScope others(processes.size());
  policy->widen(others, key);
  const Key from = std::max(key, present.key());
  for (const ProcessId process : others.added())
    removed += graph.rollback(process, from, affected, removal());
  if (removed > 0) {
    ++present.counters.rollbacks;
    present.counters.states_removed += removed;
    present.counters.processes_rolled_back += affected.size();
    present.counters.deepest_cascade =
        std::max<std::uint64_t>(present.counters.deepest_cascade, affected.size());
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
  for (const ProcessId process : others.added()) affected.push_back({process, from});
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
    schedule_group_check(t.process);
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

// A stepped arc counts as far as it was computed, and every step as an integration, once a group.
double count_steps(Counters& counters, const State& state) {
  const GroupArc& arc = *state.group->arc;
  if (state.member == 0) {
    counters.integrations += arc.counts().steps;
    counters.implicit_steps += arc.counts().steps;
    counters.rejected_steps += arc.counts().rejected;
    counters.factorizations += arc.counts().factorizations;
    counters.force_evaluations += arc.counts().evaluations;
  }
  return arc.reached() - arc.start().time;
}

bool stepped(const State& state) { return state.group && !state.group->at_rest; }

}  // namespace

// A discarded arc counts up to its claimed time.
void Kernel::note_removed(State& state) {
  const Body& body = body_of(state.process);
  if (!body.dynamic() || !state.starts_arc()) return;
  const double end = std::min(process(body).claim.time, state.next ? state.next->key.time : never);
  double length = std::max(0.0, end - state.key.time);
  // a body at rest claims for ever
  if (!std::isfinite(length)) length = 0;
  if (stepped(state)) length = count_steps(present.counters, state);
  present.counters.integration_length += length;
  present.counters.rollback_length += length;
  present.counters.deepest_rollback = std::max(present.counters.deepest_rollback, length);
}

// A state that GVT has passed: its arc was used up to the next one.
StateGraph::OnRelease Kernel::release() {
  return [this](State& state) {
    if (!body_of(state.process).dynamic() || !state.starts_arc()) return;
    const State* next = state.next;
    while (next && !next->starts_arc()) next = next->next;
    if (next) present.counters.kinematic_work += kinematic_work_of(state, next->key.time);
    if (stepped(state))
      present.counters.integration_length += count_steps(present.counters, state);
    else if (next)
      present.counters.integration_length += next->key.time - state.key.time;
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
  for (const auto& body : scene.bodies)
    if (const State* s = graph.tail(body->process); s->key == key && s->prev)
      name.add(state_checksum(*s->prev));
  StateImage now = image_of_ring(graph, key);
  if (const auto known = undone_.find(name.value()); known != undone_.end()) {
    const std::string difference = now.first_difference(scene, known->second.image);
    TW_ASSERT(difference.empty(), "redoing " + show(key) + " gave another " + difference);
    undone_.erase(known);
    return;
  }

  std::vector<Affected> affected;
  for (const auto& body : scene.bodies)
    if (graph.tail(body->process)->key == key) {
      graph.rollback(body->process, key, affected, removal());
      break;
    }
  TW_ASSERT(graph_checksum(graph) == checksum_before, "undoing " + show(key) + " left a trace");
  undone_[name.value()] = {key.time, std::move(now)};
  treat(affected);
}

}  // namespace tw
