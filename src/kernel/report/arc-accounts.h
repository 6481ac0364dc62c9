// What arcs that are done with add to the statistics: how long they were, and the work of kinematic
// bodies along them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/arc/arc-end.h"
#include "timeline/state-graph.h"

namespace tw {

struct Simulation;

// For states that a rollback removes: a discarded arc counts up to its claimed time.
StateGraph::OnRelease count_discarded(Simulation& simulation);
// For states that GVT has passed: what follows from a state was used up to the next one.
StateGraph::OnRelease count_used(Simulation& simulation);
// What was integrated of the state's arc from the state to a time, s: nothing of what rests.  Of an
// arc that is stepped all is the first state's: of a group what was computed, of others what was
// used, and what was forgotten where they halted.
double integrated_length(const State& state, double until);
// By kinematic bodies on the state's process from the state to a time along its arc, J.
double kinematic_work_of(const Simulation& simulation, const State& state, double until);
// Why the arc of the state of a group's member ended at that key.
EndReason why_ended(const State& state, const Key& by);

}  // namespace tw
