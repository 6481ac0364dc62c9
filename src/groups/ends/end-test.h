// The end test: where the arcs of a group really end.
//
// A group is integrated with the contacts it had at the start.  Before anybody relies on its arcs,
// each pair in contact is looked at where they end, and in between where it moves far: a feature
// that came down unrepresented, or a contact that closes faster than its spring is meant for, ends
// the arcs where it touches (in a small group all arcs, else those of the two), and the group check
// that stands there takes it in.
// So the end is a function of the group alone.
//
// Cost: one manifold a pair, none for pairs that moved less than a fraction of their
// contact's depth.
// Source: doc/numerics/checks-and-rest.md, "The end test" (missed features gain energy).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/surroundings.h"
#include "groups/group.h"
#include "groups/told/group-counters.h"

namespace tw {

// Integrates the group to its next check and finds where its arcs end; does nothing the second
// time.
void test_end(const Scene& scene, const Surroundings& surroundings, Group& group,
              GroupCounters& counters);

}  // namespace tw
