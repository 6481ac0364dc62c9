// Entering a discontinuity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/discontinuities.h"

#include <algorithm>

#include "base/limits.h"
#include "groups/regroup/region.h"
#include "groups/regroup/regroup.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/pair-checks.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/arc-accounts.h"

namespace tw {
namespace {

// A motion that is not finite, or runs away, becomes a speculative error of its body.
void check_finite(Successor& successor) {
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

}  // namespace

Discontinuities::Discontinuities(Simulation& simulation, ActivePairs& pairs, PairChecks& checks,
                                 CallbackBook& callbacks, Claims& claims)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      checks_(checks),
      callbacks_(callbacks),
      claims_(claims),
      undo_redo_(simulation) {}

// An error stops whole groups: adds the group mates of the successors, and gives all the first
// one's error.
void Discontinuities::stop_group_mates(const Before& before,
                                       std::vector<Successor>& successors) const {
  const std::exception_ptr error = successors.front().data.error;
  std::vector<ProcessId> stopped;
  for (const Successor& successor : successors)
    if (successor.body->dynamic()) insert(stopped, successor.process());
  const Region region = region_of(before, stopped, true);
  for (const std::vector<ProcessId>* part : {&region.inside, &region.border})
    for (const ProcessId process : *part)
      if (std::none_of(successors.begin(), successors.end(),
                       [&](const Successor& s) { return s.process() == process; }))
        successors.push_back(make_successor(before, process, false));
  for (Successor& successor : successors) successor.data.error = error;
}

// The successors give their slots, collisions and errors away.
void Discontinuities::append(const Key& key, std::vector<Successor>& successors) {
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
    const bool alone = successor.starts_arc() && successor.body->dynamic() && !successor.data.group;
    if (alone) let_move(sim_.scene, *successor.body, successor.data);
    State* state = sim_.graph.append(successor.process(), key);
    static_cast<StateData&>(*state) = std::move(successor.data);
    ring.push_back(state);
    if (!state->starts_arc() || !successor.body->dynamic()) continue;
    TW_ASSERT(!state->group || state->group->key == key || state->error,
              "state of " + successor.body->info.name + " at " + show(key) + " in an older group");
    // those of moving groups are counted by steps, when they are done with, and rest is none
    if (!state->trajectory().stepped() && !(state->group && state->group->at_rest))
      ++counters_.integrations;
  }
  sim_.graph.close_ring(ring);
}

std::size_t Discontinuities::remove(ProcessId process, const Key& key,
                                    std::vector<Affected>& affected) {
  return sim_.graph.rollback(process, key, affected, count_discarded(sim_));
}

void Discontinuities::enter(const Key& key, std::vector<Successor>& successors) {
  TW_ASSERT(key.time >= sim_.present.gvt, show(key) + " lies before GVT " + show(sim_.present.gvt));
  const std::uint64_t checksum = sim_.options.undo_redo ? graph_checksum(sim_.graph) : 0;

  // queues: room for the new states, then the states
  std::vector<Affected> affected;
  std::size_t removed = 0;
  for (const Successor& successor : successors)
    if (successor.enters()) removed += remove(successor.process(), key, affected);
  // whom the policy adds loses nothing that is past: between runs others may have had more
  // discontinuities at the present time than those whom an edit concerns
  RollbackScope others(sim_.processes.size());
  sim_.policy->widen(others, key);
  const Key from = std::max(key, sim_.present.key());
  for (const ProcessId process : others.added()) removed += remove(process, from, affected);
  if (removed > 0) {
    ++counters_.rollbacks;
    counters_.states_removed += removed;
    counters_.processes_rolled_back += affected.size();
    counters_.deepest_cascade = std::max<std::uint64_t>(counters_.deepest_cascade, affected.size());
  }
  append(key, successors);

  // receivers are treated from `key` where their arc changed, others from the least key lost
  const std::size_t rolled_back = affected.size();
  for (const Successor& successor : successors) {
    const bool arc_changed = successor.role == Role::new_arc;
    const auto end = affected.begin() + static_cast<std::ptrdiff_t>(rolled_back);
    const auto known = std::find_if(
        affected.begin(), end, [&](const Affected& t) { return t.process == successor.process(); });
    if (known != end)
      known->least_removed = std::min(known->least_removed, key);
    else if (arc_changed)
      affected.push_back({successor.process(), key});
  }
  for (const ProcessId process : others.added()) affected.push_back({process, from});
  treat(affected);
  // what a user changed nobody would find again
  if (sim_.options.undo_redo && removed == 0 && !is_edit(key)) take_back_once(key, checksum);
}

void Discontinuities::treat(const std::vector<Affected>& affected) {
  for (const Affected& t : affected)
    if (!sim_.body_of(t.process).fixed()) claims_.fall_back(t.process, t.least_removed);
  for (const Affected& t : affected) {
    const Process& process = sim_.processes[number(t.process)];
    for (const BodyId body : process.bodies)
      for (const std::uint32_t index : pairs_.of(body)) checks_.reset(index, t.least_removed);
    for (const std::uint32_t callback : process.callbacks)
      callbacks_.rewind(callback, t.least_removed);
  }
}

// Whatever it was will be found again, its events come first.
void Discontinuities::take_back_once(const Key& key, std::uint64_t checksum_before) {
  if (undo_redo_.redone(key)) return;
  std::vector<Affected> affected;
  for (const Process& process : sim_.processes)
    if (sim_.graph.tail(process.id)->key == key) {
      remove(process.id, key, affected);
      break;
    }
  undo_redo_.require_no_trace(key, checksum_before);
  treat(affected);
}

std::size_t Discontinuities::roll_back(ProcessId process, const Key& key) {
  std::vector<Affected> affected;
  const std::size_t removed = remove(process, key, affected);
  treat(affected);
  return removed;
}

void Discontinuities::restart_future() {
  undo_redo_.forget();
  const Key now = sim_.present.key();
  std::vector<Affected> affected;
  for (const Process& process : sim_.processes) remove(process.id, now, affected);
  pairs_.drop_all();
  std::vector<Affected> all;
  for (const Process& process : sim_.processes) all.push_back({process.id, now});
  treat(all);
}

void Discontinuities::retry_errors() {
  std::vector<Affected> affected;
  for (const Process& process : sim_.processes) {
    const State* tail = sim_.graph.tail(process.id);
    if (tail->error) remove(process.id, tail->key, affected);
  }
  treat(affected);
}

}  // namespace tw
