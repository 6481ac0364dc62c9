// After a discontinuity: what touches and is approached too fast for a spring gets an impulse
// without restitution, fastest first; what does not touch yet is left to collision checks.
//
// A blow has been taken up before (blow.h): this is for what a check finds, and for what was too
// much for the blow.
//
// Source: doc/numerics/impacts.md, "Impulses that a check finds".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// Takes out the pairs that carry nothing and close fast.  Returns the processes at the border that
// an impulse would reach; then nothing is as it should be.
std::vector<ProcessId> propagate_impulses(Regrouping& work);

}  // namespace tw
