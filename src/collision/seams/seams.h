// Seams: contacts with ground made of several pieces, as if it were one.
//
// Two boxes side by side are a floor with two buried walls in it: a body that slides over the seam
// must not run into them (*ghost* contacts).  Only the ground needs this: what is fixed, and
// unions.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "base/constants.h"
#include "collision/manifold/manifold.h"

namespace tw {

// A neighbour at a seam: a fixed body other than the one in contact, or another part of it.
struct SeamNeighbour {
  const ConvexPart* part = nullptr;
  Frame frame;  // of its body
};

// Whether the contact at `point` (world, on the surface of `part`) with `normal` (unit, world,
// outward of the part) is a ghost: its neighbours bury that edge, vertex or inner wall.
//
// A neighbour Q that holds the point denies the contact where the point isn't the nearest of Q to
// point + epsilon normal: then the normal is not among those that the surface of the two together
// has there.  A body with a positive distance to them all keeps its nearest contact: if c is its
// point nearest to the part, then Q is nearer to c than the part is.  The normal of a face is that
// of a ghost only where the face is denied all around the point too (an inner wall, not the bottom
// of a valley), and that of a round part only where its surface does not come out of the
// neighbours near by (the crease between a ball and a bar is a valley).
//
// `size` (m) is that of the bodies in contact: points within 1e-5 of it are the same point, and
// normals within `angle` (rad) the same normal; `depth` (m): of the contact, for a wall that is
// pressed deep is looked at from farther around.  Source: doc/numerics/seams.md.
bool buried_edge(const ConvexPart& part, const Frame& frame, const Vec3& point, const Vec3& normal,
                 const std::vector<SeamNeighbour>& neighbours, double size,
                 double angle = seam::same_angle, double depth = 0);

// Manifolds where seams matter: as `manifold`, but without ghosts.  `around_a`: the parts of
// *other* fixed bodies near a, where a is fixed; likewise for b; the other parts of a union are its
// own neighbours.  `size` as above.  Returns the least distance of the pairs of parts (m; negative:
// depth), ghosts or not, if it is within reach; else infinity.
//
// Where bodies overlap a little the axis of least depth may be that of a buried wall, while another
// axis supports.  Then the points are those of the exposed edges that lie deepest in the other
// polyhedron, and its vertices under the face that they leave the ground by (exposed-edges.h,
// seam-polyhedra.cc).  In a valley all slopes hold a vertex (valley.h).  A round part is scaled
// down until it is apart: what is nearest then is no ghost (see buried_edge), and has its depth
// along that normal.
double manifold_at_seams(const Shape& a, const Frame& frame_a,
                         const std::vector<SeamNeighbour>& around_a, const Shape& b,
                         const Frame& frame_b, const std::vector<SeamNeighbour>& around_b,
                         double reach, double size, std::vector<ManifoldPoint>& out,
                         ReferenceChoice choice = ReferenceChoice::larger);

}  // namespace tw
