// Who is squeezed: pressed from two sides by what does not give way, so that it has nowhere to go.
//
// A body is squeezed from when two contacts push it against each other, one of them deeper than a
// share of the thinner one's thickness (dynamics/body.h), and behind each stands what does not give
// way: a fixed or kinematic body, or a dynamic one that is itself pushed along from behind, and so
// on to a fixed or kinematic one, without the squeezed body in between.  They push it against each
// other where the forces of their springs, friction's with them, are more than 120 degrees apart
// and neither side is small beside the other: so a ball is squeezed, too, that friction jams in a
// corner.  A body at the bottom of a stack is not, however heavy the stack is.  It is squeezed
// until no two push it so at half that depth.
//
// So is one, too, that a single contact presses deeper than the limit of its law
// (dynamics/second-hardening.h), and than that of a default one as a share of the thickness: by a
// force, a spring or a motor of more than some million weights.  Of two such bodies it is the one
// that moves, or the thinner one.
//
// Asked at each discontinuity of its group, of the poses and contacts there: a function of what is
// committed.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/contacts.h"

namespace tw {

// Notes in the successors with new arcs who is squeezed from here on and since when; tells of those
// whose squeezing begins.
Told note_squeezed(const Regrouping& work, const Contacts& contacts);

}  // namespace tw
