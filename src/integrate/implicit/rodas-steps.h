// Steps of RODAS4 through a contact group.
//
// Error of a step: RMS over members of dx and radius dtheta over the position tolerance, dv and
// radius dw over the velocity tolerance; stretches are not weighed.  A rejected step's successor
// does not grow.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/arc/step-method.h"

namespace tw {

// `work` must outlive it.
std::unique_ptr<StepMethod> rodas_steps(ArcWork& work);

}  // namespace tw
