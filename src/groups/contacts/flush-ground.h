// Ground that goes on as a plane: its pieces may lie a little apart.
//
// A body that stands on the face of one piece of the ground lies as deep in that face's plane as
// its contacts give way.  Where the next piece's face lies in the same plane, the body's leading
// edge meets that piece's *side*, as far below the edge as it is deep: a wall that the pieces'
// seams would bury if they touched (collision/seams), and that is none where there is a slot
// between them, either, nor between the slats of a belt that move.  Such contacts are ghosts.  What
// stands out of the plane is met as ever.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "collision/distance/separation.h"
#include "collision/manifold/manifold.h"
#include "dynamics/scene.h"
#include "groups/group.h"

namespace tw {

// A face of the ground that a body stands on.
struct StandingPlane {
  Vec3 normal = Vec3::UnitZ();  // unit, world, out of the ground
  double height = 0;            // m: normal.x of its points
};

// Those that a member of the group stands on at `when`, each once.
std::vector<StandingPlane> standing_planes(const Scene& scene, const Group& group,
                                           const Body& member, double when);

// Two bodies at one instant; a contact's number of a pair of parts names one of each.
struct PairPlace {
  const Body& a;
  const Frame& frame_a;
  const Body& b;
  const Frame& frame_b;
};

// Leaves the contacts with such sides out of those of the two, one of which stands on these planes
// and the other is no dynamic body: those at a side of a part of the ground, no deeper below a face
// of it that lies in one of the planes than contacts may be.  The other part is above that plane,
// but for as much: what hangs down beside the ground meets its sides.  True if there were any.
bool drop_low_sides(const std::vector<StandingPlane>& planes, const PairPlace& pair,
                    std::vector<ManifoldPoint>& points);
bool drop_low_sides(const std::vector<StandingPlane>& planes, const PairPlace& pair,
                    std::vector<ContactPoint>& points);

}  // namespace tw
