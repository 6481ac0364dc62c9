// After an impact on a member of a group: what touches it and is now approached too fast for a
// spring gets an impulse without restitution, fastest first; what does not touch yet is left to
// collision checks.
//
// The two that struck each other belong to it: a heavy body that comes down on a light one is
// stopped by as many blows as it is heavier, for the floor gives back each time what the light one
// was given.  Each as an impact of its own would cost new arcs for the whole group.
//
// Source: doc/numerics.md, "Contact groups".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// Takes out the pairs that carry nothing and close fast.  Returns the processes at the border that
// an impulse would reach; then nothing is as it should be.
std::vector<ProcessId> propagate_impulses(Regrouping& work);

}  // namespace tw
