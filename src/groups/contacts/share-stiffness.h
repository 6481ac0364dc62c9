// How the contacts of a pair share its stiffness.
//
// Each point has 1 / (points that touch or lie flat beside such) of it, those on coplanar
// neighbours of the ground taken together, and points at one place taken for one.  With m_i the
// points at the place of i, itself among them, and n_i the places in its plane: 1 / (n_i m_i).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/contacts.h"

namespace tw {

// Sets `share` of all contacts.
void share_stiffness(const Scene& scene, Contacts& contacts);

}  // namespace tw
