// Making groups: one of each part (parts.h), with its arc; who is in none flies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regroup/parts.h"

namespace tw {

struct MadeGroups {
  Groups all;
  std::vector<std::shared_ptr<Group>>
      of;  // of each successor with a new arc, by its place; or null
  // of what was placed touching (placed-loads.h)
  std::vector<std::uint64_t> unloaded;  // ascending
  double placed_energy = 0;             // J
};

// `contacts`: sorted.  Of successors that come to rest the velocities become 0.
MadeGroups make_groups(const Regrouping& work, const Contacts& contacts, Parts& parts);

// Tells each successor with a new arc which group it is in, and what it follows.
void enter_groups(const Regrouping& work, const MadeGroups& made);

}  // namespace tw
