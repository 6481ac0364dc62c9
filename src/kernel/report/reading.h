// What can be asked of a world: states, energy, momentum, contacts, the hash of its history.
//
// `when` is a time at which the states are kept: that of the present, or of a frame that is due.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "dynamics/placed-body.h"
#include "groups/told/contact-survey.h"
#include "timeline/state.h"

namespace tw {

struct Simulation;

// The last state that holds at the time: before an error, and between runs of the past alone.
const State* state_at(const Simulation& simulation, BodyId id, double when);
// The state of each body that holds at the instant.
StateOf states_at(const Simulation& simulation, double when);
PoseTwist point_at(const Simulation& simulation, BodyId id, double when);
// Kinetic, of gravity, of contact springs and of springs, J.
double total_energy(const Simulation& simulation, double when);
// Linear, of dynamic bodies, kg m/s.
Vec3 total_momentum(const Simulation& simulation, double when);

// Hash of a state at one instant, as it enters the history's hash.
std::uint64_t state_hash(const Body& body, const Key& key, const PoseTwist& point,
                         const StateData& data);
// SHA-256 of what is committed and of every body's state at the present time.
std::string history_hash(const Simulation& simulation);

}  // namespace tw
