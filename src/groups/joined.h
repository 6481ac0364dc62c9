// Who is joined to whom: the links of a multibody are processes that never part.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "dynamics/scene.h"

namespace tw {

// Null where the process is no link's.
const Multibody* multibody_of(const Scene& scene, ProcessId process);
// Adds the other links of all multibodies that have one in the row (ascending).
void add_joined(const Scene& scene, std::vector<ProcessId>& processes);

}  // namespace tw
