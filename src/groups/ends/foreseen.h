// What a check finds as it was foreseen.
//
// A ball that rolls on, a box that slides on a floor: the contacts that the arc began with are
// those that the check at its end finds, where it followed them to.  Such a check was not needed,
// so the next one may come after twice the time, and so on, up to the time after which what hardly
// moves is looked at, or in which it moves by its own thickness (check-times.cc).  The first that
// finds anything else (a contact more or less, one that is elsewhere, an arc that ended early), and
// whatever changes the group otherwise, begins anew; so does what is watched for rest.  A function
// of the group and of the one before it, as everything of a group is.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/regroup/parts.h"

namespace tw {

// Whether a contact is where the one before, of whose bodies the first is named, was followed to;
// `size`: of the lesser body, m.
bool is_foreseen(const NewContact& fresh, const ContactForce& followed, BodyId reference,
                 double size);

// How many times the time to the next check of a group is doubled, after the group of the same
// members that was there before.
int doublings_of(const Regrouping& work, const Contacts& contacts, const Parts& parts,
                 const Group& group, const Group& before);

}  // namespace tw
