// Who is joined to whom: the links of a multibody, and what a spring or a hold ties together, are
// processes of one group, whatever else becomes of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/components.h"
#include "groups/regroup/regrouping.h"

namespace tw {

// Adds all that is joined to some of the row (ascending), before the key.
void add_joined(const Before& before, std::vector<ProcessId>& processes);

// Whether the successor is in a group also where it touches nothing: a link, or what is tied.
bool is_in_group(const Successor& successor);
// Calls visit(i, j) for the places of joined successors that have new arcs: enough to know all.
template <class Visit>
void visit_joined(const Regrouping& work, Visit&& visit);

// ---- templates ----

template <class Visit>
void visit_joined(const Regrouping& work, Visit&& visit) {
  for (std::size_t i = 0; i < work.successors.size(); ++i) {
    const Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    if (const Multibody* multibody = successor.body->multibody)
      visit(i, work.place_of(work.successor_of(multibody->links.front())));
    for (const BondPtr& bond : bonds_of(successor.data.forces))
      visit(i, work.place_of(work.successor_of(bond->other(successor.body->id()))));
  }
}

}  // namespace tw
