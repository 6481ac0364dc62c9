// A body at the border of a group: it follows the arc that it has, in a group of its own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "dynamics/motion.h"
#include "kernel/group.h"

namespace tw {

// The motion of the principal frame of a member of `group`, until its next check; keeps the group alive.
// Integrates the group's arc to its end at once, so that looking at it never integrates.
MotionPtr make_group_motion(std::shared_ptr<Group> group, int member);

}  // namespace tw
