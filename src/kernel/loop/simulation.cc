// When a world may be changed, and what follows from its settings.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/simulation.h"

#include <string>

#include "base/error.h"
#include "multibody/multibody.h"

namespace tw {

void Simulation::require_between_runs(const char* what) const {
  TW_REQUIRE(!running,
             std::string(what) + " inside a callback or observer; expected to be between runs");
}

void Simulation::require_before_first_run(const char* what) const {
  TW_REQUIRE(!present.begun,
             std::string(what) + " after the simulation began; expected before the first run");
}

void Simulation::scale_joints() {
  for (const auto& multibody : scene.multibodies)
    multibody->tree.set_gravity(scene.gravity_scale());
}

}  // namespace tw
