// The end test: where the arcs of a group really end.
//
// A group is integrated with the contacts it had at the start.  Before anybody relies on its arcs,
// each pair in contact is looked at where they end, and in between where it moves far.  Where a
// feature came down unrepresented, a contact claims a depth that is not there, or an open one
// closed faster than its spring is meant for, the arcs of the two end, and where a joint got to a
// stop, those of its multibody; in a small group those of all.  The group check that stands there
// takes it in.  An arc may also have taken as many steps as it may.  All of this is a function of
// the group alone.
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
