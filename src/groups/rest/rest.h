// Rest: which members of a group move no more.
//
// One rule, for each member.  It is *slow* while its fastest point is.  It is *still* after it was
// slow throughout a watch of at least some times that in which it would fall over, if in the second
// half of the watch it had all but stopped (it settles), or was no faster and stayed in its place
// (it trembles): a tower that begins to tip gets faster, a ball that creeps gets away.  Where the
// watch ends with neither, it begins anew for what got faster, else goes on for twice as long: so
// what settles slowly is found, too; where all that is left of its speed is rounding, such a long
// watch is broken off for a short one.  A still member *can rest* if all that it touches is slow or
// stands still.  Whether its contacts slip is not asked: what slides gets away or stops, and what
// presses with next to nothing may slip for ever.
//
// At a check those that can rest are laid to rest: their arcs are constant and have no end.  If
// that is all of those that hang together, nothing is left to compute; if it is only some, they
// stand still at the border of what goes on (region.h), and wake where the force on them changes.
// So one stone that rocks keeps no heap awake.  Few of many are not worth a border.
//
// Speeds are shares of sqrt(g size) with size the least width, times multiples of sqrt(radius / g):
// a scene that is scaled comes to rest when its original does.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "groups/components.h"
#include "groups/contacts/contacts.h"

namespace tw {

// The book of a successor with a new arc, from here on.  `touches`: whether it is in contact.
Stillness stillness_of(const Regrouping& work, const Successor& successor, bool touches);

// Of the successors, by their places.
struct Watched {
  const std::vector<bool>& touching;        // who is in contact with anything
  const std::vector<Stillness>& stillness;  // their books
};

// Which successors come to rest at a check.  `together`: the places of those that hang together by
// contact pairs.
std::vector<bool> who_rests(const Regrouping& work, const Contacts& contacts,
                            const Watched& watched, Components& together);

}  // namespace tw
