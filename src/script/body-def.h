// What a scene says of a body, from Scheme.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include "kernel/definitions.h"

namespace tw {

// From an alist of properties (symbols) and values.  Errors: BadValue, with the property's name;
// UserError for a property that bodies lack, which names `who` was called.
BodyDef to_body_def(SCM alist, const char* who);

}  // namespace tw
