// How deep boxes and balls overlap, apart from all that src/collision does.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw::bench {

// A ball has no half edges, a box no radius.
struct BoxOrBall {
  Vec3 half_edges = Vec3::Zero();
  double radius = 0;
  Frame frame;
  double reach() const { return radius + half_edges.norm(); }
};

// The shortest way by which one of the two gets clear of the other, m; 0 where they are apart.
// Of two boxes it is along a normal of either or across an edge of each (the faces of their
// Minkowski difference).
double overlap(const BoxOrBall& a, const BoxOrBall& b);

}  // namespace tw::bench
