// The table of statistics: names and definitions are fixed (doc/statistics.md).
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sys/resource.h>

#include <algorithm>

#include "collision/separation.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

std::int64_t whole(std::uint64_t n) { return static_cast<std::int64_t>(n); }

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

std::int64_t peak_resident_bytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

}  // namespace

StatisticsTable Kernel::statistics() const {
  std::int64_t moving = 0;
  for (const auto& body : scene.bodies) moving += !body->fixed();

  // arcs that still stand count up to the present
  double length = present.counters.integration_length,
         kinematic_work = present.counters.kinematic_work;
  std::uint64_t kinematic_arcs = 0;
  std::uint64_t steps = 0, factorizations = 0;  // of groups that still stand
  for (const auto& body : scene.bodies) {
    if (body->info.kind == BodyKind::kinematic) {
      length += present.time;
      ++kinematic_arcs;
    }
    if (!body->dynamic()) continue;
    for (const State* s = graph.head(body->process); s; s = s->next) {
      if (!s->starts_arc() || s->key.time > present.time) continue;
      const State* next = s->next;
      while (next && !next->starts_arc()) next = next->next;
      const double until = std::min(present.time, next ? next->key.time : present.time);
      kinematic_work += kinematic_work_of(*s, until);
      if (s->group && !s->group->at_rest) {
        const GroupArc& arc = *s->group->arc;
        length += arc.reached() - arc.start().time;
        if (s->member == 0) {
          steps += arc.counts().steps;
          factorizations += arc.counts().factorizations;
        }
        continue;
      }
      length += until - s->key.time;
    }
  }

  const double bodies_moving = static_cast<double>(std::max<std::int64_t>(1, moving));
  const std::uint64_t integrations = present.counters.integrations + kinematic_arcs + steps;
  const std::uint64_t discontinuities = present.counters.collisions + present.counters.fusions +
                                        present.counters.fissions +
                                        present.counters.callback_changes;
  const double fps = sinks.empty() ? 30 : sinks.front().fps;
  const double frames = std::max(1.0, present.time * fps);

  return {
      {"duration", present.time},
      {"frames", sinks.empty() ? std::int64_t{0} : std::int64_t{sinks.front().next_frame}},
      {"bodies_moving", moving},
      {"bodies_total", whole(scene.bodies.size() - present.removals)},
      {"discontinuities", whole(discontinuities)},
      {"collisions", whole(present.counters.collisions)},
      {"fusions", whole(present.counters.fusions)},
      {"fissions", whole(present.counters.fissions)},
      {"callback_changes", whole(present.counters.callback_changes)},
      {"contact_changes", whole(present.counters.contact_changes)},
      {"avg_time_between_discontinuities",
       ratio(present.time, static_cast<double>(discontinuities))},
      {"avg_integration_step", ratio(length, static_cast<double>(integrations))},
      {"integrations", whole(integrations)},
      {"integration_per_moving_body", length / bodies_moving},
      {"rollback_per_moving_body", present.counters.rollback_length / bodies_moving},
      {"rollbacks", whole(present.counters.rollbacks)},
      {"states_rolled_back", whole(present.counters.states_removed)},
      {"deepest_rollback", present.counters.deepest_rollback},
      {"largest_cascade", whole(present.counters.deepest_cascade)},
      {"cpu_seconds", present.counters.cpu_seconds},
      {"cpu_seconds_per_frame", present.counters.cpu_seconds / frames},
      {"events", whole(present.counters.events)},
      {"events_postponed", whole(present.counters.events_postponed)},
      {"claims", whole(present.counters.claims)},
      {"candidates", whole(present.counters.candidates)},
      {"predictions", whole(present.counters.predictions)},
      {"checks", whole(present.counters.checks)},
      {"certificates", whole(present.counters.certificates)},
      {"active_pairs_avg",
       ratio(present.counters.pair_sum, static_cast<double>(present.counters.events))},
      {"distance_queries", static_cast<std::int64_t>(distance_queries - queries_before_)},
      {"callbacks_run", whole(present.counters.callbacks_run)},
      {"groups", whole(present.counters.groups)},
      {"group_checks", whole(present.counters.group_checks)},
      {"largest_group_bodies", whole(present.counters.largest_group_bodies)},
      {"largest_group_contacts", whole(present.counters.largest_group_contacts)},
      {"early_ends", whole(present.counters.early_ends)},
      {"manifolds", whole(present.counters.manifolds)},
      {"implicit_steps", whole(present.counters.implicit_steps + steps)},
      {"rejected_steps", whole(present.counters.rejected_steps)},
      {"factorizations", whole(present.counters.factorizations + factorizations)},
      {"gvt_computations", whole(present.counters.gvt_computations)},
      {"peak_states", whole(graph.peak_state_count())},
      {"peak_rss_bytes", peak_resident_bytes()},
      {"max_penetration", present.counters.max_penetration},
      {"impulses_given_up", whole(present.counters.impulses_given_up)},
      {"impacts_declared_soft", whole(present.counters.declared_soft)},
      {"momentum_dropped", present.counters.momentum_dropped},
      {"kinematic_work", kinematic_work},
      {"energy_start",
       present.counters.energy_known ? present.counters.energy_start : total_energy(present.time)},
      {"energy_end", total_energy(present.time)},
      {"policy", std::string(policy->name())},
      {"accuracy", present.settings.accuracy},
      {"seed", static_cast<std::int64_t>(options.seed)},
  };
}

}  // namespace tw
