// Explicit steps of a multibody that touches nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/arc/step-method.h"

namespace tw {

// Null where the group is another one, or something at its joints is stiff and does not swing
// widely.  `work` must outlive it.
std::unique_ptr<StepMethod> tree_steps(ArcWork& work);

}  // namespace tw
