// What stands still: fixed bodies, and members of groups at rest.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/trajectory.h"

namespace tw {

// A body that never moves.  Nothing acts on it: its path is the simplest of parabolas.
TrajectoryPtr make_standing(const Pose& pose);

// A body at rest, carried by its contacts until something touches it: not ballistic.
TrajectoryPtr make_resting(const Pose& pose);

}  // namespace tw
