// Loads at the start: what is placed touching begins with its contacts loaded.
//
// What touches beside others and carries nothing in that balance is not in contact yet: balls in a
// row take a blow as impacts, one by one.
//
// A spring that is born without a load lets the weight fall on it: a stack sinks and trembles, a
// box on a slope slips a little before its friction holds.  So where a body touches others from the
// place that it was put at, and they hardly part or close, the group's contacts begin with the
// forces that their springs would settle to, and each contact's gap is offset by the depth that
// makes this force.
//
// With u the displacements (and rotations) of the members, linear in the contacts' displacements
// d = J u, the springs k and kt of the contacts and their cones:
//   M (u - u')/tau^2 = W + J^T f(u),   N = k max(0, -n.d),   F = -kt (1 - n n^T) d cut to mu N,
// or F = -mu N slip/|slip| where the two slide already; solved for u by Newton's method, again from
// u' = u until nothing more comes.  Where there is a balance the left side goes to 0: of all forces
// that hold the group these have the least energy in the springs.  Where there is none the left
// side is the acceleration of what begins to move, and the forces are those at which it does.  A
// function of the bodies and contacts alone.
//
// The energy in these springs is given with the poses; it is counted apart (Tally::placed_energy).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/contacts/contacts.h"

namespace tw {

// When what is in this state was put where it is, as far as its state tells, s; -never: long ago.
double placed_at(const State& state);

// What parts or closes no faster hardly does, m/s: so fast is what was placed touching by the time
// the two meet.
double placed_speed(const Scene& scene, double size);

// Whether that was so lately that it cannot have fallen farther since than bodies may overlap when
// they come into the world.
bool is_just_placed(const Scene& scene, const Body& body, const State& state, double now);

// Whether the fusion of these is one of bodies that were placed touching: what falls farther than
// bodies may overlap when they come into the world was not.
bool are_placed(const Before& before, const std::vector<ProcessId>& struck);

// These bodies and all that were placed together with them, ascending.
std::vector<BodyId> placed_with(const Before& before, const std::vector<ProcessId>& struck,
                                const PlacedTogether* together);

struct PlacedLoads {
  std::vector<std::uint64_t> unloaded;  // pairs that carry nothing: with any nothing is loaded
  double energy = 0;                    // J, that the springs got
};

// Gives the contacts of a group at its start their loads, if all that touch there hardly
// part or close.  `contacts`: those of the start, as they look now.
PlacedLoads load_placed(const Regrouping& work, GroupStart& start,
                        const std::vector<NewContact>& contacts);

}  // namespace tw
