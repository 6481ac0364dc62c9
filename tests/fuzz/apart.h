// Running something in a process of its own, so that what crashes or hangs is a finding too.
//
// A run that stands still within one arc does not come back for its slice, and a bug of ours
// aborts: both end the process, and what it had found until then is in shared memory.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>

#include "fuzz/findings.h"

namespace tw::fuzz {

// What `run` finds, which gets `cpu` seconds of CPU (whole seconds, at least one).
Findings run_apart(double cpu, const std::function<void(Findings&)>& run);

}  // namespace tw::fuzz
