// What a multibody may be made of: the checks of one link by itself.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/tree.h"

namespace tw::multibody {

// Errors: see Tree.
void require_link(const LinkSpec& spec);

}  // namespace tw::multibody
