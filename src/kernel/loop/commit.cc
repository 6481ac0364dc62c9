// GVT and commit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/commit.h"

#include <algorithm>

#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/arc-accounts.h"
#include "kernel/report/delivery.h"
#include "kernel/report/reading.h"
#include "timeline/swept-bounds.h"

namespace tw {

Commit::Commit(Simulation& simulation, const ActivePairs& pairs, CallbackBook& callbacks,
               Delivery& delivery)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      callbacks_(callbacks),
      delivery_(delivery) {}

void Commit::begin_run(double until, double wall_end) {
  const WorldOptions& options = sim_.options;
  if (!trace_ && !(options.write_states.empty() && options.compare_states.empty()))
    trace_ = std::make_unique<StateTrace>(sim_.scene, options.write_states, options.compare_states);
  until_ = until;
  wall_end_ = wall_end;
}

// GVT and commit cost busy processes + pairs; often enough to keep queues and boxes short, rarely
// enough to be cheap.
bool Commit::gvt_is_due() const {
  if (sim_.options.gvt_interval > 0) return events_since_gvt_ >= sim_.options.gvt_interval;
  const std::size_t scanned = sim_.graph.busy().size() + pairs_.live();
  return events_since_gvt_ >= static_cast<long>(std::max<std::size_t>(64, scanned / 4));
}

bool Commit::finished() const {
  const EventQueue& queue = sim_.queue;
  if (queue.empty()) return true;
  return queue.top_priority() > until_ && compute_gvt() > until_;
}

// Claims, callbacks and known impacts are events at their own time; a pair that is followed on the
// grid is safe only up to its last check, before its event.
double Commit::compute_gvt() const {
  double least = sim_.queue.least_time();
  for (const Pair& pair : pairs_.records())
    if (pair.live && !pair.parked) least = std::min(least, pair.safe_time());
  return least;
}

void Commit::update_gvt() {
  ++counters_.gvt_computations;
  events_since_gvt_ = 0;
  const double least = compute_gvt();
  TW_ASSERT(least >= sim_.present.gvt,
            "GVT would fall from " + show(sim_.present.gvt) + " to " + show(least));
  const bool inclusive = least > until_;
  const double limit = std::min(least, until_);
  if (limit == never) return;  // nothing moves and nothing is asked for
  if (limit > sim_.present.gvt || inclusive) commit(limit, inclusive);
}

// Everything before `limit` (at it, too, if inclusive) is final.  What is committed is so before
// observers hear of it: an error of theirs leaves the world at its last committed time.
void Commit::commit(double limit, bool inclusive) {
  const std::exception_ptr error = error_before(limit, inclusive);
  commit_states(limit, inclusive);
  Present& present = sim_.present;
  // an error at the present instant takes nothing back of what was final there
  inclusive = inclusive || (present.due.inclusive && limit == present.due.time);
  present.gvt = present.time = limit;
  present.due = {limit, inclusive};
  if (error)
    delivery_.deliver(never);
  else if (delivery_.is_worth_it())
    delivery_.deliver(wall_end_);
  free_states(limit);
  if (error) std::rethrow_exception(error);
}

// The error of the first stopped process that GVT passes, null if there is none: then the commit
// ends where it stopped.
std::exception_ptr Commit::error_before(double& limit, bool& inclusive) const {
  const State* first = nullptr;
  for (const ProcessId process : sim_.graph.busy()) {
    const State* tail = sim_.graph.tail(process);
    if (!tail || !tail->error) continue;
    if (tail->key.time < limit || (inclusive && tail->key.time == limit))
      if (!first || tail->key < first->key) first = tail;
  }
  if (!first) return nullptr;
  limit = first->key.time;
  inclusive = false;
  return first->error;
}

void Commit::commit_states(double limit, bool inclusive) {
  const auto passed = [&](const State* s) {
    return s->key.time < limit || (inclusive && s->key.time == limit);
  };
  for (const ProcessId process : sim_.graph.busy()) {
    // back from the tail to the last committed one, then forward
    State* state = sim_.graph.tail(process);
    while (state && state->prev && !state->prev->committed) state = state->prev;
    if (!state || state->committed) continue;
    for (; state && passed(state) && !state->error; state = state->next) commit_state(*state);
  }
  delivery_.sort_noted();
  if (trace_) trace_->check(limit, inclusive);
}

void Commit::commit_state(State& state) {
  state.committed = true;
  if (trace_) trace_->add(state);
  count(state);
  if (state.key.kind == KeyKind::callback) callbacks_.note_committed(state);
  if (state.report) delivery_.note(state.report);
  if (sim_.options.hash && state.changed) {
    const Body& body = sim_.body_of(state.process);
    HistorySum& history = sim_.present.history;
    history.sum += state_hash(body, state.key, state.trajectory().at(state.key.time), state);
    ++history.count;
  }
}

void Commit::count(const State& state) {
  if (state.starts_arc() && state.prev && state.prev->group)
    counters_.arcs_ended.note(why_ended(*state.prev, state.key));
  counters_.kinematic_work += state.tally.kinematic_work;
  counters_.placed_energy += state.tally.placed_energy;
  counters_.max_penetration = std::max(counters_.max_penetration, state.tally.depth);
  counters_.squeezed += state.tally.squeezed;
  counters_.squeezed_depth = std::max(counters_.squeezed_depth, state.tally.squeezed_depth);
  counters_.squeezed_share = std::max(counters_.squeezed_share, state.tally.squeezed_share);
  // each ring is counted by its member with the least id
  const bool impact = state.key.kind == KeyKind::impact;
  const bool call = state.key.kind == KeyKind::callback && state.changed;
  bool first = impact || call;
  for (const State* r = state.ring; first && r != &state; r = r->ring)
    first = state.process < r->process;
  if (first && impact) ++counters_.collisions;
  if (first && call) ++counters_.callback_changes;
  counters_.fusions += state.tally.fusions;
  // their keys are those of impacts; what was placed touching comes together at one of them
  if (impact && state.tally.fusions > 0) --counters_.collisions;
  counters_.fissions += state.tally.fissions;
  counters_.contact_changes += state.tally.contact_changes;
  counters_.impulses_given_up += state.tally.impulses_given_up;
  counters_.declared_soft += state.tally.declared_soft;
  counters_.momentum_dropped += state.tally.momentum_dropped;
}

// Keeps the last state at or before the limit, and what frames that are still due will read.
void Commit::free_states(double limit) {
  limit = delivery_.first_needed(limit);
  for (const ProcessId process : sim_.graph.busy()) {
    State* keep = sim_.graph.last_at_or_before_time(process, limit);
    // ties: an edit at the limit may follow the first of several states there
    while (keep && !keep->committed) keep = keep->prev;
    if (keep) sim_.graph.free_before(keep, count_used(sim_));
  }
  sim_.graph.tidy_busy();
}

}  // namespace tw
