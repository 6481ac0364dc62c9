// What contact groups cost: for statistics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "dynamics/ids.h"

namespace tw {

// The arc that took most: steps taken and rejected, and whose it was.
struct DearestArc {
  std::uint64_t steps = 0, rejected = 0;
  double start = 0;  // s
  std::vector<ProcessId> members;

  std::uint64_t tried() const { return steps + rejected; }
};

struct GroupCounters {
  // steps of groups, discarded ones too; each is an integration
  std::uint64_t integrations = 0;
  std::uint64_t implicit_steps = 0, rejected_steps = 0, factorizations = 0, force_evaluations = 0;
  double integration_length = 0;  // s, of arcs that were integrated to no end, a body each

  // groups, as made
  std::uint64_t groups = 0, manifolds = 0, early_ends = 0;
  std::uint64_t largest_group_bodies = 0, largest_group_contacts = 0;
  DearestArc dearest_arc;

  void add(const GroupCounters& other) {
    integrations += other.integrations;
    implicit_steps += other.implicit_steps;
    rejected_steps += other.rejected_steps;
    factorizations += other.factorizations;
    force_evaluations += other.force_evaluations;
    integration_length += other.integration_length;
    groups += other.groups;
    manifolds += other.manifolds;
    early_ends += other.early_ends;
    largest_group_bodies = std::max(largest_group_bodies, other.largest_group_bodies);
    largest_group_contacts = std::max(largest_group_contacts, other.largest_group_contacts);
    if (other.dearest_arc.tried() > dearest_arc.tried()) dearest_arc = other.dearest_arc;
  }
};

}  // namespace tw
