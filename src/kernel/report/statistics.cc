// The table of statistics: names and definitions are fixed (doc/statistics.md).
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sys/resource.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "kernel/loop/simulation.h"
#include "kernel/report/arc-accounts.h"
#include "kernel/report/delivery.h"
#include "kernel/report/reading.h"
#include "kernel/report/statistics.h"

namespace tw {
namespace {

std::int64_t whole(std::uint64_t n) { return static_cast<std::int64_t>(n); }

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

std::int64_t peak_resident_bytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

// Names of bodies: the first few, and how many there are.
std::string names_of(const Scene& scene, std::span<const BodyId> bodies) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, bodies.size()); ++i)
    text += (i > 0 ? ", " : "") + scene.body(bodies[i]).info.name;
  return bodies.size() > most ? text + ", .. (" + std::to_string(bodies.size()) + ")" : text;
}

std::vector<BodyId> bodies_of(const Scene& scene, const std::vector<ProcessId>& members) {
  std::vector<BodyId> bodies;
  for (const ProcessId member : members) bodies.push_back(scene.body_of(member).id());
  return bodies;
}

std::string line_of(const DearestGroup& group) {
  std::ostringstream text;
  text << group.names << ": " << group.steps << " steps, " << group.rejected << " rejected, "
       << group.arcs << " arcs, " << group.contacts << " contacts, " << group.since << " to "
       << group.until << " s, most ended by " << group.ended_by;
  return text.str();
}

}  // namespace

std::vector<DearestGroup> dearest_groups_of(const Simulation& simulation) {
  std::vector<DearestGroup> result;
  for (const GroupEffort& effort : simulation.present.counters.dearest_groups.sorted())
    result.push_back({names_of(simulation.scene, bodies_of(simulation.scene, effort.members)),
                      effort.members.size(), effort.contacts, effort.arcs, effort.steps,
                      effort.rejected, effort.since, effort.until, effort.ends.most_frequent()});
  return result;
}

namespace {

// Arcs that still stand count up to the present, with those that are done with.
struct Integrated {
  double length = 0, kinematic_work = 0;  // s, J
  std::uint64_t arcs = 0;                 // each step of those that are stepped
  std::uint64_t implicit = 0, factorizations = 0;
};

Integrated integrated_by(const Simulation& simulation) {
  const Present& present = simulation.present;
  const Counters& counters = present.counters;
  Integrated sum{counters.integration_length, counters.kinematic_work, counters.integrations,
                 counters.implicit_steps, counters.factorizations};
  for (const auto& body : simulation.scene.bodies) {
    if (body->info.kind == BodyKind::kinematic) {
      sum.length += present.time;
      ++sum.arcs;
    }
    if (!body->dynamic()) continue;
    for (const State* s = simulation.graph.head(body->process); s; s = s->next) {
      if (s->key.time > present.time) break;
      const State* next = s->next;
      const auto until = [&] { return std::min(present.time, next ? next->key.time : never); };
      sum.kinematic_work += kinematic_work_of(simulation, *s, until());
      const bool stepped = s->trajectory().stepped();
      while (stepped && next && !next->starts_arc()) next = next->next;
      sum.length += integrated_length(*s, until());
      if (!stepped || !s->starts_arc()) continue;
      const Effort effort = s->trajectory().effort();
      sum.arcs += effort.steps;
      if (effort.implicit) sum.implicit += effort.steps;
      sum.factorizations += effort.factorizations;
    }
  }
  return sum;
}

void add(StatisticsTable& table, StatisticsTable rows) {
  std::move(rows.begin(), rows.end(), std::back_inserter(table));
}

StatisticsTable motion_rows(const Simulation& simulation, const Delivery& delivery,
                            const Integrated& sum) {
  const Present& present = simulation.present;
  const Counters& counters = present.counters;
  const Scene& scene = simulation.scene;
  std::int64_t bodies_moving = 0;
  for (const auto& body : scene.bodies) bodies_moving += !body->fixed();
  const double moving = static_cast<double>(std::max<std::int64_t>(1, bodies_moving));
  const std::uint64_t discontinuities =
      counters.collisions + counters.fusions + counters.fissions + counters.callback_changes;
  return {
      {"duration", present.time},
      {"frames", std::int64_t{delivery.frames()}},
      {"bodies_moving", bodies_moving},
      {"bodies_total", whole(scene.bodies.size() - present.removals)},
      {"discontinuities", whole(discontinuities)},
      {"collisions", whole(counters.collisions)},
      {"fusions", whole(counters.fusions)},
      {"fissions", whole(counters.fissions)},
      {"callback_changes", whole(counters.callback_changes)},
      {"contact_changes", whole(counters.contact_changes)},
      {"avg_time_between_discontinuities",
       ratio(present.time, static_cast<double>(discontinuities))},
      {"avg_integration_step", ratio(sum.length, static_cast<double>(sum.arcs))},
      {"integrations", whole(sum.arcs)},
      {"integration_per_moving_body", sum.length / moving},
      {"rollback_per_moving_body", counters.rollback_length / moving},
      {"rollbacks", whole(counters.rollbacks)},
      {"states_rolled_back", whole(counters.states_removed)},
      {"deepest_rollback", counters.deepest_rollback},
      {"largest_cascade", whole(counters.deepest_cascade)},
  };
}

StatisticsTable work_rows(const Simulation& simulation, const Delivery& delivery,
                          const WorkCount& work) {
  const Counters& counters = simulation.present.counters;
  const double frames = std::max(1.0, simulation.present.time * delivery.fps());
  return {
      {"cpu_seconds", counters.cpu_seconds},
      {"cpu_seconds_per_frame", counters.cpu_seconds / frames},
      {"threads", std::int64_t{simulation.threads()}},
      {"helper_cpu_seconds", work.helper_seconds},
      {"events", whole(counters.events)},
      {"events_postponed", whole(counters.events_postponed)},
      {"claims", whole(counters.claims)},
      {"candidates", whole(counters.candidates)},
      {"predictions", whole(counters.predictions)},
      {"checks", whole(counters.checks)},
      {"certificates", whole(counters.certificates)},
      {"active_pairs_avg", ratio(counters.pair_sum, static_cast<double>(counters.events))},
      {"distance_queries", whole(work.distance_queries)},
      {"callbacks_run", whole(counters.callbacks_run)},
  };
}

StatisticsTable group_rows(const Simulation& simulation, const Integrated& sum) {
  const Counters& counters = simulation.present.counters;
  StatisticsTable table{
      {"groups", whole(counters.groups)},
      {"group_checks", whole(counters.group_checks)},
      {"checks_decided_ahead", whole(counters.checks_decided_ahead)},
      {"checks_decided_in_vain",
       whole(counters.checks_decided_ahead - counters.check_decisions_used)},
      {"impacts_decided_ahead", whole(counters.impacts_decided_ahead)},
      {"impacts_decided_in_vain",
       whole(counters.impacts_decided_ahead - counters.impact_decisions_used)},
      {"largest_group_bodies", whole(counters.largest_group_bodies)},
      {"largest_group_contacts", whole(counters.largest_group_contacts)},
      {"early_ends", whole(counters.early_ends)},
      {"manifolds", whole(counters.manifolds)},
      {"implicit_steps", whole(sum.implicit)},
      {"rejected_steps", whole(counters.rejected_steps)},
      {"factorizations", whole(sum.factorizations)},
  };
  // (who rests has no end)
  for (std::size_t i = 1; i < end_names.size(); ++i)
    table.push_back({std::string("arcs_ended_") + end_names[i], whole(counters.arcs_ended.of[i])});
  return table;
}

// What was dear.
StatisticsTable dear_rows(const Simulation& simulation) {
  const Counters& counters = simulation.present.counters;
  const Scene& scene = simulation.scene;
  StatisticsTable table{
      {"dearest_pair_checks", whole(counters.dearest_pair_checks)},
      {"dearest_pair",
       counters.dearest_pair_checks > 0 ? names_of(scene, counters.dearest_pair) : std::string()},
      {"dearest_arc_steps", whole(counters.dearest_arc.steps)},
      {"dearest_arc_rejected", whole(counters.dearest_arc.rejected)},
      {"dearest_arc_start", counters.dearest_arc.start},
      {"dearest_arc_bodies", names_of(scene, bodies_of(scene, counters.dearest_arc.members))},
  };
  constexpr std::size_t shown = 5;
  const std::vector<DearestGroup> groups = dearest_groups_of(simulation);
  for (std::size_t i = 0; i < shown; ++i)
    table.push_back({"dearest_group_" + std::to_string(i + 1),
                     i < groups.size() ? line_of(groups[i]) : std::string()});
  return table;
}

StatisticsTable truth_rows(const Simulation& simulation, const Integrated& sum) {
  const Present& present = simulation.present;
  const Counters& counters = present.counters;
  return {
      {"gvt_computations", whole(counters.gvt_computations)},
      {"peak_states", whole(simulation.graph.peak_state_count())},
      {"peak_rss_bytes", peak_resident_bytes()},
      {"max_penetration", counters.max_penetration},
      {"squeezed", whole(counters.squeezed)},
      {"squeezed_depth", counters.squeezed_depth},
      {"squeezed_share", counters.squeezed_share},
      {"impulses_given_up", whole(counters.impulses_given_up)},
      {"soft_after_repeats", whole(counters.declared_soft)},
      {"momentum_dropped", counters.momentum_dropped},
      {"kinematic_work", sum.kinematic_work},
      {"placed_energy", counters.placed_energy},
      {"energy_start",
       counters.energy_known ? counters.energy_start : total_energy(simulation, present.time)},
      {"energy_end", total_energy(simulation, present.time)},
      {"policy", simulation.policy->name()},
      {"accuracy", present.settings.accuracy},
      {"seed", static_cast<std::int64_t>(simulation.options.seed)},
  };
}

}  // namespace

StatisticsTable statistics_of(const Simulation& simulation, const Delivery& delivery,
                              const WorkCount& work) {
  const Integrated sum = integrated_by(simulation);
  StatisticsTable table = motion_rows(simulation, delivery, sum);
  add(table, work_rows(simulation, delivery, work));
  add(table, group_rows(simulation, sum));
  add(table, dear_rows(simulation));
  add(table, truth_rows(simulation, sum));
  return table;
}

}  // namespace tw
