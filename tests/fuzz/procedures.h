// Motions and forces of described scenes that are procedures of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "fuzz/described-scene.h"

namespace tw::fuzz {

// Of a body that has a swing.
TrajectoryPtr make_swing(const DescribedBody& body, const Shape& shape);
// `number`: tells it from the others.
std::shared_ptr<ForceProcedure> make_force(const DescribedForce& force, std::uint64_t number);

}  // namespace tw::fuzz
