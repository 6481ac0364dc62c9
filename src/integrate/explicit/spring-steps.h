// Explicit steps of bodies on springs that touch nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/arc/step-method.h"

namespace tw {

// Null where the group is another one, or its springs don't swing widely where it has come to.
// `work` must outlive it.
std::unique_ptr<StepMethod> spring_steps(ArcWork& work);

}  // namespace tw
