// The contact graph: which pairs are in contact, at which points, and what becomes of their
// friction stretches.
//
// Candidates are who was in contact before, and whom the spatial hash has near: new contacts are
// looked for no farther than its boxes are grown, so none is missed, however small claims and GVT
// make them.  Whether they are in contact says pair-look.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/contacts.h"

namespace tw {

// The contacts that hold from here on: at a check those of the processes `struck` (ascending) anew;
// at a fusion those of the first two successors and of all that were placed together with them
// besides; the others as they stand.
Contacts find_contacts(const Regrouping& work, const std::vector<ProcessId>& struck);

}  // namespace tw
