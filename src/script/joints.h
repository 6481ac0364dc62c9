// Whose joints a Scheme procedure means, and a joint by its name.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <libguile.h>

#include <string>

#include "kernel/world/callback.h"
#include "kernel/world/world.h"

namespace tw {

// A multibody, a link of one, or a view of a link.
struct Jointed {
  SCM object;
  World& world;
  const Multibody& multibody;
};

// BadValue where the object is none of these; `what` was asked for.
Jointed to_jointed(SCM object, const char* what);

// The link of this name, a symbol or a string; and the one that the joint of this name moves, which
// may be called by the link's as well.  UserError with the names there are.
int to_link(const Multibody& multibody, SCM name);
int to_joint(const Multibody& multibody, SCM name);
// A name given as a symbol or a string.
std::string to_link_name(SCM name, const char* what);

// Where the joints stand: at the world's time, or of a view at its event.
MultibodyState read_joints(const Jointed& of, const char* what);
// By an edit, or through the view.
void change_joints(const Jointed& of, const char* what,
                   const std::function<void(MultibodyState&)>& change);

}  // namespace tw
