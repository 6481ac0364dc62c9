// Springs and holds between two bodies: what is checked, and the bond that follows.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/world/definitions.h"
#include "timeline/successor.h"

namespace tw {

class Kernel;
struct Simulation;

// As of World (world.h); edits at the present time.
ForceHandle add_spring(Kernel& kernel, const SpringDef& def);
void attach(Kernel& kernel, BodyId a, BodyId b, const HoldDef& def);
void detach(Kernel& kernel, BodyId a, BodyId b);
// `when`: the present, or the time of a frame that is due.
bool attached(const Simulation& simulation, BodyId a, BodyId b, double when);

// The hold between two successors as they are.
//
// Its stiffness carries the weight of the lighter with a sag of answer::hold_sag of the lesser
// size; a link has the mass of all its multibody.  Against turning it is as stiff times the square
// of the longer lever from the point where it holds to a centre of mass, and of the lesser radius
// of gyration: so a weight at the end of a lever sinks no more.
//
// Errors: UserError where the two are one, are held already, or neither is dynamic; constants that
// are negative or not finite.
Bond make_hold(const Scene& scene, const Successor& a, const Successor& b, const HoldDef& def);

}  // namespace tw
