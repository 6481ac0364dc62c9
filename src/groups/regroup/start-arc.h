// How the arc of a group starts: members, outside bodies, contacts and bonds as the integrator
// wants them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/placed/placed-loads.h"

namespace tw {

// Until when one at a border knows where it goes, s.
double known_until(const Regrouping& work, const Successor& successor);

// Of a group that is made but for its arc; its pairs name their contacts among `contacts`, and from
// here on those of the arc.
PlacedLoads start_arc(const Regrouping& work, const Contacts& contacts, Group& group);

}  // namespace tw
