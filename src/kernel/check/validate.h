// Validators: the kernel's invariants as functions, run after every event under --check.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

namespace tw {

class ActivePairs;
class CallbackBook;
class Claims;
struct Simulation;

// Empty, or the first invariant that does not hold.
std::string validate_state_graph(const Simulation& simulation);
std::string validate_event_queue(const Simulation& simulation, const ActivePairs& pairs,
                                 const CallbackBook& callbacks);
std::string validate_pairs(const Simulation& simulation, const ActivePairs& pairs);
std::string validate_residences(const Simulation& simulation);
std::string validate_claims(const Simulation& simulation, const Claims& claims);

}  // namespace tw
