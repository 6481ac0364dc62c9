// When group checks happen.
//
// At k 2^j / 480 s, j such that no surface point moves more than a twentieth of its body's size in
// between, or a multiple of that while all goes on as foreseen (foreseen.h)
// (doc/numerics/checks-and-rest.md: finer is cheaper while bodies collide, coarser else), within
// bounds that follow from the sizes of the members: a scene that is scaled is checked at scaled
// times.  What moves farther between two checks is looked at in between by the end test.
//
// The lattice is that of the world, not of each group: neighbours that have nothing to do with each
// other begin their arcs together, so that a pair of them is looked at once a stretch, and all that
// is due at one instant can be done at once.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regroup/regrouping.h"
#include "timeline/state.h"

namespace tw {

// From now to the next check of a group of these, s: on the grid of checks.  `doublings`: of what
// their motion asks for (foreseen.h).
double check_interval(const Regrouping& work, const std::vector<ProcessId>& members,
                      int doublings = 0);

// The shortest time between two checks that a member asks for, s: by its size, or as set.
double finest_check(const Scene& scene, const Body& body);

// The shortest arc of a group, s: nothing that is found ends one sooner.  Links without a shape
// have no size; 0 if there is nothing else.
double least_arc(const Scene& scene, const std::vector<ProcessId>& members);

// The longest interval of the lattice that is no longer than a time, s.
double interval_within(const Scene& scene, double time);

// The time between two checks of a multibody that touches nothing, s: its arc is integrated anew
// and its stops are looked at no oftener than it would fall through its own size.
double joint_check_interval(const Scene& scene, const Multibody& multibody);
// The same of a body on springs or holds.
double bond_check_interval(const Scene& scene, const Body& body);
// The grid on which checks after calls of that period lie, s: a fraction of it.
double call_check_grid(double period);

// The first check after `now`: the last time of the lattice that is no farther than the interval,
// and no nearer than half of it; else of the lattice of half the interval, from which the one after
// it gets there.  (Checks at once after a touch made energy rise in twice as many random scenes.)
double next_check_time(double now, double interval);
// The same of a group with a border: that of its neighbours, however near.
double next_common_check_time(double now, double interval);

// The key of a check at `when`, but for its id, which is that of the least member: just before
// whatever else happens to the group then.
Key group_check_key(const Group& group, double when);

// The key at which the arc of a process ends by itself at `when`: by a check of its group, or, of
// an isolated body that cannot be followed any further, by an error.
Key end_key(const State& state, double when);

}  // namespace tw
