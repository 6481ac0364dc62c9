// A spring from a body to a point of what stands or moves as it was given.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/forces.h"
#include "integrate/trajectory.h"

namespace tw {

// `arm`: where it holds the body, principal frame; `anchor`: where it holds the other, in the frame
// of its motion.  `stands`: the other never moves.
struct SpringAnchor {
  BodyId body = no_body;
  TrajectoryPtr motion;
  bool stands = false;
  Vec3 anchor = Vec3::Zero();
};
ForceLawPtr make_anchored_spring(const SpringLaw& law, const Vec3& arm, SpringAnchor anchor);

}  // namespace tw
