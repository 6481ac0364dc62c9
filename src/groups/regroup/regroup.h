// Regrouping: from what a discontinuity changed to the arcs and groups of all whom that reaches.
//
// A function of the scene, of what stands before the key and of who is near: it changes nothing.
// Where the arcs of somebody whom it would need are not known as far as the key, it says whom it
// waits for, and is asked again.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <variant>
#include <vector>

#include "groups/regroup/region.h"

namespace tw {

// What it makes: the successors of all that take part, in the order of the ring: first those given.
struct Regrouped {
  std::vector<Successor> successors;
};

// The arcs of these must be known as far as the key first.
struct Waits {
  Region region;
};

// Whether the arcs of a process are known as far as the key, so that nothing can come before it.
using Known = std::function<bool(ProcessId)>;

// `struck`: those that the discontinuity changed, with new arcs where it changed their motion, and
// the others that it looked at.  `counters`: what it cost is added.
std::variant<Regrouped, Waits> regroup(const Before& before, const Surroundings& surroundings,
                                       const Known& known, const RegroupRequest& request,
                                       const std::vector<Successor>& struck,
                                       GroupCounters& counters);

// Whether some of them starts an arc and comes from a group: then there is something to regroup.
bool touches_groups(const std::vector<Successor>& successors);

// The state that stands before the key, evaluated at its time: with a new arc or carrying the old
// one.
Successor make_successor(const Before& before, ProcessId process, bool new_arc);

}  // namespace tw
