// What arcs that are done with add to the statistics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/report/arc-accounts.h"

#include <algorithm>
#include <cmath>

#include "groups/told/contact-survey.h"
#include "kernel/loop/simulation.h"

namespace tw {
namespace {

// Every step counts as an integration, once a group.
Effort count_steps(Counters& counters, const Trajectory& trajectory) {
  const Effort effort = trajectory.effort();
  counters.integrations += effort.steps;
  if (effort.implicit) counters.implicit_steps += effort.steps;
  counters.rejected_steps += effort.rejected;
  counters.factorizations += effort.factorizations;
  counters.force_evaluations += effort.evaluations;
  return effort;
}

const State* next_arc(const State& state) {
  const State* next = state.next;
  while (next && !next->starts_arc()) next = next->next;
  return next;
}

}  // namespace

EndReason why_ended(const State& state, const Key& by) {
  switch (by.kind) {
    case KeyKind::impact: return EndReason::impact;
    case KeyKind::callback: return EndReason::callback;
    case KeyKind::group_check: {
      const ArcEnd end = state.group->end_of(state.member);
      return end.time == by.time ? end.reason : EndReason::neighbour;
    }
    default: return EndReason::edit;
  }
}

double integrated_length(const State& state, double until) {
  if (state.group && state.group->at_rest) return 0;
  const double length = until - state.key.time;
  if (!state.trajectory().stepped()) return length;
  if (!state.starts_arc()) return 0;
  const Effort effort = state.trajectory().effort();
  return (state.group ? effort.length : std::min(effort.length, length)) + effort.forgotten;
}

StateGraph::OnRelease count_discarded(Simulation& simulation) {
  return [&simulation](State& state) {
    Counters& counters = simulation.present.counters;
    const Body& body = simulation.body_of(state.process);
    if (!body.dynamic() || !state.starts_arc()) return;
    const double end =
        std::min(simulation.process(body).claim.time, state.next ? state.next->key.time : never);
    // a body at rest claims for ever
    const double until = std::isfinite(end) ? std::max(end, state.key.time) : state.key.time;
    const double length = integrated_length(state, until);
    if (state.trajectory().stepped()) count_steps(counters, state.trajectory());
    counters.integration_length += length;
    counters.rollback_length += length;
    counters.deepest_rollback = std::max(counters.deepest_rollback, length);
  };
}

StateGraph::OnRelease count_used(Simulation& simulation) {
  return [&simulation](State& state) {
    Counters& counters = simulation.present.counters;
    if (!simulation.body_of(state.process).dynamic()) return;
    const State* next = state.next;
    if (next) counters.kinematic_work += kinematic_work_of(simulation, state, next->key.time);
    if (state.trajectory().stepped()) {
      if (state.starts_arc())
        counters.rollback_length += count_steps(counters, state.trajectory()).forgotten;
      next = next_arc(state);
    }
    if (next || state.trajectory().stepped())
      counters.integration_length += integrated_length(state, next ? next->key.time : never);
  };
}

// Nothing is computed in worlds without kinematic bodies.
double kinematic_work_of(const Simulation& simulation, const State& state, double until) {
  return simulation.kinematic.empty() ? 0 : contact_work(simulation.scene, state, until);
}

}  // namespace tw
