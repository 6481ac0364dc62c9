// Cutting a regrouping into groups: what hangs together is one, what touches nothing flies.
//
// Fixed and kinematic bodies, and those at the border, hold nothing together; what sleeps and what
// is awake are groups of their own.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// From the successors and their contacts; sorts the pairs, makes the groups and their starts, notes
// what changed, and tells each successor which group it is in.
void make_groups(Regrouping& work);

}  // namespace tw
