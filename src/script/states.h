// The state of a body at its world's time, or of a view at its event.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include "kernel/world/world.h"

namespace tw {

// Errors: BadValue for what is neither; UserError for a body within a callback.  `what` is the
// procedure that reads.
BodyState read_state(SCM object, const char* what);
// What sensors on it read; errors as of read_state.
SensedMotion read_sensed(SCM object, const char* what);
// What is known of it apart from its motion.
const BodyInfo& info_of(SCM object);

}  // namespace tw
