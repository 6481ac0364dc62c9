// What a body sweeps along its arc.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/body.h"
#include "integrate/trajectory.h"

namespace tw {

// A box around everything the body sweeps over [from, to]; bounded shapes only.
Aabb swept_bounds(const Body& body, const Trajectory& trajectory, double from, double to);

}  // namespace tw
