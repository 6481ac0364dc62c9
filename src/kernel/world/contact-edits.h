// Contact parameters that are set: who is concerned, and what stays as it is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <utility>

#include "dynamics/contact-parameters.h"

namespace tw {

class Kernel;

// For all of these pairs of sides or, where it is refused, for none.  Groups take what they hold
// contacts by from where they begin: those in which it has changed begin anew, others go on.
//
// Errors: a value out of its range; two that may collide from now on and overlap.
void set_contact(Kernel& kernel, std::span<const std::pair<ContactSide, ContactSide>> sides,
                 const ContactSettings& settings);

}  // namespace tw
