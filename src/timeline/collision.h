// What a discontinuity tells observers and collision callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "dynamics/ids.h"
#include "math/vec.h"
#include "timeline/key.h"

namespace tw {

enum class CollisionKind : unsigned char { collision, fusion, fission, squeezed };

// A committed or just computed collision, as callbacks and observers see it; observers also see the
// fusions of two processes at a contact, the fissions, one for each contact that broke, and who is
// squeezed from then on between body1 and body2 (which may be one), along the normal.
struct Collision {
  CollisionKind kind = CollisionKind::collision;
  Key key;
  BodyId body1 = 0, body2 = 0;  // body1 < body2
  double time = 0;
  Vec3 point = Vec3::Zero();    // world, m: of the largest impulse
  Vec3 normal = Vec3::UnitZ();  // unit, world, from body1 to body2
  double speed = 0;             // approach speed there before the impulse, m/s, positive
  double impulse = 0;           // sum of the normal impulses, N s
  BodyId squeezed = 0;
  // Of the deeper of two overlaps: m, and over the thinner one's thickness.
  double depth = 0, depth_share = 0;
};

// What one discontinuity tells observers.
using Report = std::vector<Collision>;

}  // namespace tw
