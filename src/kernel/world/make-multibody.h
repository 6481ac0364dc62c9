// From how a multibody comes into a world to its tree, its links' bodies and its joints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "kernel/world/definitions.h"
#include "multibody/multibody.h"

namespace tw {

// Without its links, which come later.  Errors: those of the tree and of the links' mass
// properties; no links; a free base with several first links or one that has a joint of its own.
std::shared_ptr<Multibody> make_multibody(const MultibodyDef& def, std::uint32_t number);

// All joints at 0, or at the limit that is nearest to it, at rest against the base; a free first
// link where the multibody is put.
MultibodyStatePtr joints_at_birth(const Multibody& multibody, const MultibodyDef& def, double now);

// The links as bodies, where these joints put them.
std::vector<BodyDef> link_bodies(const Multibody& multibody, const MultibodyDef& def,
                                 const MultibodyState& joints);

// The links that a joint or a weld joins to this one, ascending.
std::vector<int> neighbours_of(const multibody::Tree& tree, int link);
// Whether a joint or a weld joins it to the base.
bool hangs_on_base(const multibody::Tree& tree, int link);

}  // namespace tw
