// Rest and sleep: which members of a group move no more.
//
// *Rest* is decided for whole groups: slow for a while, no loaded contact slipping, and slower in
// the end than at first (what tips over slowly gets faster, what settles gets slower).
//
// *Sleep* is rest for the time being.  One stone that rocks would keep a heap awake; so at the
// check of a large group those of its members that hardly move are laid to rest as groups of their
// own, in which the others see still bodies at their border (region.h), and which wake where the
// forces on them change.  A member falls asleep when it was slow for a while without getting faster
// or away (so neither a tower that begins to tip nor a ball that creeps), no loaded contact of it
// slips, and everything that it touches is slow or still, too.
//
// A group that comes to rest beside sleeping ones falls asleep instead, as long as something moves
// that touches any of those that hang together with it.  When the last one would come to rest, they
// all wake, and all come to rest together by the rule for whole groups: nothing stays frozen that
// would have moved.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regrouping.h"

namespace tw {

// Fills in the books of the successors, and who of them falls asleep.
void note_stillness(Regrouping& work);

// Whether the group, the same members as `before`, has come to rest; keeps its book.
bool comes_to_rest(const Regrouping& work, Group& group, const Group& before);

// Who sleeps beside groups that would come to rest now, and all sleepers that hang together with
// them: they wake instead; ascending.
std::vector<ProcessId> wakes_with(const Regrouping& work);

// Whether something that moves touches the sleepers: then they sleep on.  `in_motion`: those that
// do so and keep their arcs; ascending.
bool disturbed(const Regrouping& work, const std::vector<ProcessId>& sleepers,
               std::vector<ProcessId>& in_motion);

}  // namespace tw
