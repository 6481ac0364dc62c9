// What a group follows of a point of a manifold.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/manifold/manifold.h"
#include "integrate/arc/group-arc.h"

namespace tw {

// The contact's geometry, in the frames of the bodies that the point names as reference and other;
// the parts are those that it is on.  Everything else is left as it is by default.
GroupContact followed_contact(const ManifoldPoint& p, const Frame& reference,
                              const ConvexPart& reference_part, const Frame& other,
                              const ConvexPart& other_part);

}  // namespace tw
