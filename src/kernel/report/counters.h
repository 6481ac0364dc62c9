// What the kernel counts while it runs (statistics.cc makes the table).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include "groups/told/group-counters.h"

namespace tw {

// What it takes to follow pairs.
struct PairCounts {
  std::uint64_t checks = 0, certificates = 0, predictions = 0;
  // of a pair for as long as its boxes overlap: looks at grid points, and whose they were
  std::uint64_t dearest_pair_checks = 0;
  BodyId dearest_pair[2] = {};

  void add(const PairCounts& other) {
    checks += other.checks;
    certificates += other.certificates;
    predictions += other.predictions;
    if (other.dearest_pair_checks <= dearest_pair_checks) return;
    dearest_pair_checks = other.dearest_pair_checks;
    std::copy_n(other.dearest_pair, 2, dearest_pair);
  }
};

struct Counters : GroupCounters, PairCounts {
  using GroupCounters::add;
  using PairCounts::add;

  // events, as processed
  std::uint64_t events = 0, events_postponed = 0, claims = 0;
  std::uint64_t candidates = 0, pairs_made = 0, gvt_computations = 0;
  double pair_sum = 0;  // live pairs, summed over processed events: for the average

  // rollback
  std::uint64_t rollbacks = 0, states_removed = 0, processes_rolled_back = 0;
  std::uint64_t deepest_cascade = 0;  // most processes in one rollback
  double deepest_rollback = 0;        // s, from the cause to the latest state removed
  double rollback_length = 0;         // s, summed over bodies

  std::uint64_t group_checks = 0;
  // on several threads: decided before their events, and of these the ones that held
  std::uint64_t checks_decided_ahead = 0, check_decisions_used = 0;
  std::uint64_t impacts_decided_ahead = 0, impact_decisions_used = 0;

  // committed
  std::uint64_t fusions = 0, fissions = 0, contact_changes = 0;
  std::uint64_t collisions = 0, callback_changes = 0, callbacks_run = 0;
  std::uint64_t impulses_given_up = 0, declared_soft = 0;
  EndCounts arcs_ended;         // of bodies in groups
  double momentum_dropped = 0;  // N s, at borders of regions
  double kinematic_work = 0;    // J, by kinematic bodies on dynamic ones
  double placed_energy = 0;     // J, of contact springs that started loaded
  double max_penetration = 0;   // m, deepest overlap at impacts, in contacts and at frames
  std::uint64_t squeezed = 0;   // bodies that began to be, which max_penetration leaves out
  double squeezed_depth = 0, squeezed_share = 0;  // m; over the thinner one's thickness

  // time of this thread, s
  double cpu_seconds = 0, output_cpu_seconds = 0;
  double energy_start = 0;
  bool energy_known = false;
};

}  // namespace tw
