// After a discontinuity: what touches and is approached too fast for a spring gets an impulse
// without restitution, fastest first; what does not touch yet is left to collision checks.
//
// A blow has been taken up before (blow.h): this is for what a check finds, and for what was too
// much for the blow.
//
// Source: doc/numerics/impacts.md, "Impulses that a check finds".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "groups/contacts/contacts.h"

namespace tw {

struct PassedOn {
  std::vector<ProcessId> at_border;   // whom an impulse would reach there; then nothing is as it
                                      // should be, and nobody has got any
  std::vector<std::uint64_t> parted;  // pairs that carry nothing and close fast; as the contacts
  Tally tally;
};

// Gives the successors their velocities.
PassedOn pass_on_impulses(const Regrouping& work, const Contacts& contacts);

}  // namespace tw
