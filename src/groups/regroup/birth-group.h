// The group that the links of a multibody are born in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <span>

#include "dynamics/scene.h"
#include "multibody/multibody.h"
#include "timeline/state.h"

namespace tw {

// Gives the newborn states of the links, a ring, their places, velocities, group and trajectories.
void make_birth_group(const Scene& scene, const std::shared_ptr<const Multibody>& multibody,
                      const MultibodyStatePtr& joints, std::span<State* const> states);

}  // namespace tw
