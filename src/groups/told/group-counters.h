// What contact groups cost: for statistics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "dynamics/ids.h"
#include "integrate/arc/arc-end.h"

namespace tw {

// The arc that took most: steps taken and rejected, and whose it was.
struct DearestArc {
  std::uint64_t steps = 0, rejected = 0;
  double start = 0;  // s
  std::vector<ProcessId> members;

  std::uint64_t tried() const { return steps + rejected; }
};

// What groups of the same members cost, arc after arc.
struct GroupEffort {
  std::vector<ProcessId> members;
  std::uint64_t contacts = 0;  // of the latest arc
  std::uint64_t arcs = 0, steps = 0, rejected = 0;
  double since = 0, until = 0;  // s
  EndCounts ends;

  std::uint64_t tried() const { return steps + rejected; }
};

// The dearest groups, more or less: one that is not among them takes the place of the cheapest, so
// that what goes on being dear gets in and stays.
class DearestGroups {
 public:
  void note(const GroupEffort& arc) {
    auto at = std::find_if(all_.begin(), all_.end(),
                           [&](const GroupEffort& e) { return e.members == arc.members; });
    if (at == all_.end() && all_.size() < most) {
      all_.push_back(arc);
    } else if (at == all_.end()) {
      *std::min_element(all_.begin(), all_.end(), [](const GroupEffort& x, const GroupEffort& y) {
        return x.tried() < y.tried();
      }) = arc;
    } else {
      at->contacts = arc.contacts;
      at->arcs += arc.arcs;
      at->steps += arc.steps;
      at->rejected += arc.rejected;
      at->ends.add(arc.ends);
      at->since = std::min(at->since, arc.since);
      at->until = std::max(at->until, arc.until);
    }
  }
  void add(const DearestGroups& other) {
    for (const GroupEffort& effort : other.all_) note(effort);
  }
  // The dearest first.
  std::vector<GroupEffort> sorted() const {
    std::vector<GroupEffort> result = all_;
    std::stable_sort(result.begin(), result.end(), [](const GroupEffort& x, const GroupEffort& y) {
      return x.tried() > y.tried();
    });
    return result;
  }

 private:
  static constexpr std::size_t most = 16;
  std::vector<GroupEffort> all_;
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
  DearestGroups dearest_groups;

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
    dearest_groups.add(other.dearest_groups);
  }
};

}  // namespace tw
