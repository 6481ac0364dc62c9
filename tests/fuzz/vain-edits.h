// Edits that leave nothing behind.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/world/world.h"

namespace tw::fuzz {

// Edits that are refused, such that change nothing, and bodies that come, or go, and are undone:
// what follows is what would have followed without them.  Raises an error where one of the first is
// taken.
void edit_in_vain(World& world);

}  // namespace tw::fuzz
