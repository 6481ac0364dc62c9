// A spring or a hold from a body to what stands or moves as it was given.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/forces.h"
#include "integrate/trajectory.h"

namespace tw {

// On body b of the bond; a follows `motion`.  `stands`: it never moves.
ForceLawPtr make_anchored_bond(const Bond& bond, TrajectoryPtr motion, bool stands);

}  // namespace tw
