// What the callbacks of described scenes do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "fuzz/described-scene.h"

namespace tw::fuzz {

// To a world that has the bodies.
void add_callbacks(World& world, const DescribedScene& scene);

}  // namespace tw::fuzz
