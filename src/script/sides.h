// Sides of contact rules and collision callbacks as Scheme writes them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <utility>
#include <vector>

#include "dynamics/contact-parameters.h"

namespace tw {

// A body of the world, a material (symbol), or #t for all.
ContactSide to_side(SCM world, SCM value, const char* name);
// The pairs that two of these mean, or multibodies, for each of their links.
std::vector<std::pair<ContactSide, ContactSide>> to_sides(SCM world, SCM a, SCM b);

}  // namespace tw
