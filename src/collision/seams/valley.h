// Valleys: where a face of the ground goes on beneath a neighbour.
//
// Along a valley the room above the ground is convex, and a body in it is held by both slopes.  But
// what presses on both is a little way inside the ground, and of a tip that is inside one piece the
// other piece knows nothing: it lies beside it, under the plane of its slope.  So each face goes on
// beyond those of its sides where a neighbour rises above it, as far as bodies may be sunk.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "collision/seams/seams.h"
#include "geometry/polyhedron.h"

namespace tw {

// Two plates that meet in an edge alone make a valley, too, with nothing beneath: a slit, through
// which a tip is as soon as it is sunk at all.
//
// Whether the point (frame of the polyhedron), beside the face, is over or under what the face goes
// on by beneath its neighbours: beyond each side that the foot of the point is beyond, a neighbour
// rises above the face, and a neighbour holds the foot, no more than `farthest` (m) from the face.
// A point under it is in a neighbour too: else it is on the far side of that, where there is no
// valley.  Of a slit nothing is held, but nothing lies between its border and the point, or the
// place where the body that the point is of goes through the plane; and the neighbour rises between
// what the face goes on by and the middle of that body, which tells above from below.  In any case
// the middle (`middle`, frame of the polyhedron) is over the face.  `world`: the frame of the
// polyhedron; `size` (m) as in seams.h.
bool goes_on_to(const Polyhedron& part, const Polyhedron::Face& face, const Vec3& point,
                const Vec3& middle, const Frame& world,
                const std::vector<SeamNeighbour>& neighbours, double farthest, double size);

// A place on an edge of a part of the ground, and what its neighbours make of it there.
class GroundEdge {
 public:
  // At this share of the edge, from tail to head.  `world`: the frame of the polyhedron.
  GroundEdge(const Polyhedron& part, std::size_t edge, double share, const Frame& world,
             const std::vector<SeamNeighbour>& neighbours, double size);
  // Whether both faces are open, here or (+1, -1) a little towards the head or the tail: an inner
  // wall has no edges.
  bool is_open(int towards) const;
  // Whether it goes on from here, towards its head (+1) or tail (-1), beneath a neighbour: that is
  // above one of the two faces there.
  bool goes_on(int towards) const;

 private:
  bool is_held(const Vec3& offset, double depth) const;

  const Frame& world_;
  const std::vector<SeamNeighbour>& neighbours_;
  double size_;
  Vec3 place_, along_;                  // unit, from tail to head
  Vec3 normal_[2] = {}, into_[2] = {};  // of both faces, and into them, square to the edge
};

}  // namespace tw
