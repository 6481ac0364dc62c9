// What a scene says of a body or a multibody, from Scheme.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include "kernel/world/definitions.h"

namespace tw {

// From an alist of properties (symbols) and values.  Errors: BadValue, with the property's name;
// UserError for a property that bodies lack, which names `who` was called.
BodyDef to_body_def(SCM alist, const char* who);

// A multibody without links yet: where it comes into the world and what it hangs on, a body, 'fixed
// or 'free.  Of the others #f stands for what is usual.
MultibodyDef to_root_def(SCM world, SCM name, SCM base, SCM position, SCM orientation, SCM place);

}  // namespace tw
