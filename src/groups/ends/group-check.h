// Group checks: whom a check concerns.
//
// What a check finds depends on the arcs alone: whoever hangs together and is checked at the same
// time is checked together, whichever of them comes first.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "groups/before.h"

namespace tw {

// All that hangs together with the group and is checked at the same time: the parts of a group that
// impacts have divided; ascending.  `parts`: the groups that these are; null: nobody asks.
std::vector<ProcessId> family(const Before& before, const std::shared_ptr<Group>& group,
                              Groups* parts = nullptr);

// The members whose arcs end at the key's time, before the check of their group; ascending.
std::vector<ProcessId> early_members(const Before& before, const Group& group);

// Whose motion could not be followed, when and where: for the error that stops them.
std::string failure_of(const Scene& scene, const Group& group);
// Whose time does not go on past `when`: for the error that ends it.
std::string standstill_of(const Scene& scene, const Group& group, double when);

}  // namespace tw
