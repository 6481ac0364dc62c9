// Forces that users give to bodies: what is checked, and the laws that follow.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "kernel/world/definitions.h"

namespace tw {

class Kernel;
struct Simulation;

// UserError where a constant of a force is negative or not finite.
void require_constant(double value, const std::string& what, const char* unit);

// As of World (world.h); all are edits at the present time.
ForceHandle add_drag(Kernel& kernel, BodyId id, double linear, double quadratic);
ForceHandle add_force(Kernel& kernel, BodyId id, std::shared_ptr<ForceProcedure> procedure);
bool acts(const Simulation& simulation, const ForceHandle& force);
void remove_force(Kernel& kernel, const ForceHandle& force, const std::string& what);

}  // namespace tw
