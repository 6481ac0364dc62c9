// From how a body comes into a world to the body and the state it is born in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "kernel/world/definitions.h"
#include "timeline/state.h"

namespace tw {

// Errors: UserError where a number is not finite or too large, for a body without mass, ...
std::unique_ptr<Body> make_body(const BodyDef& def, BodyId id, const std::string& name);
// The state is fresh, with its key; its arc begins there.
void make_birth(const Body& body, const BodyDef& def, const Vec3& gravity, State& state);

}  // namespace tw
