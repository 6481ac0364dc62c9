// Contact manifolds: the points at which two shapes touch or may touch soon, as features that a
// contact group can follow while the bodies move.
//
// Cold: a function of the two poses and the reach alone.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/shape.h"

namespace tw {

// What the reference body shows the other: see integrate/group-arc.h for what follows from it.
enum class ReferenceFeature : unsigned char { plane, line, point };

struct ManifoldPoint {
  bool reference_is_a = true;  // the reference body; the other has the core point
  ReferenceFeature kind = ReferenceFeature::plane;
  Vec3 normal = Vec3::UnitZ();          // unit, world, from the reference body to the other
  Vec3 direction = Vec3::UnitX();       // unit, world: line only
  Vec3 reference_point = Vec3::Zero();  // world: a point of the plane or line, or the core point
  Vec3 core_point = Vec3::Zero();       // world: of the other body
  double reference_radius = 0;          // m: of a spherical or cylindrical reference
  double radius = 0;                    // m: about the core point
  double gap = 0;                       // m, signed; > 0: not yet touching
  int pair = 0;                         // pair of parts, part_a * parts of b + part_b
  std::uint64_t feature = 0;            // stable while the same features meet
};

// Which face is the reference where faces of both bodies could be.
enum class ReferenceChoice : unsigned char {
  larger,  // the one with more area; nearly equal: that of a
  of_a,    // that of a, as where a is fixed: contacts at its seams then have its very normals
  of_b,
};

// At most this many a pair of parts.
inline constexpr std::size_t most_manifold_points = 8;

// All points with gap <= reach of every pair of parts, appended to `out`: at least one for each
// pair of parts whose distance is <= reach.  Face against face: the clipped polygon and, of the
// incident body, the vertices that may come down on the reference face (*reach points*), the
// deepest always among them.  Ordered by pair of parts, then by feature.
void manifold(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
              double reach, std::vector<ManifoldPoint>& out,
              ReferenceChoice choice = ReferenceChoice::larger);

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
// of a valley).
//
// `size` (m) is that of the bodies in contact: points within 1e-5 of it are the same point, and
// normals within `angle` (rad) the same normal.  Source of the problem: doc/numerics.md, "Contact
// points".
bool buried_edge(const ConvexPart& part, const Frame& frame, const Vec3& point, const Vec3& normal,
                 const std::vector<SeamNeighbour>& neighbours, double size, double angle = 1e-4);

// Manifolds where seams matter: as `manifold`, but without ghosts.  `around_a`: the parts of
// *other* fixed bodies near a, where a is fixed; likewise for b; the other parts of a union are its
// own neighbours.  `size` as above.  Returns the least distance of the pairs of parts (m; negative:
// depth), ghosts or not, if it is within reach; else 1e300.
//
// Where bodies overlap a little the axis of least depth may be that of a buried wall, while another
// axis supports.  Then the points are those of the exposed edges that lie deepest in the other
// polyhedron, and its vertices under the face that they leave the ground by (exposed-edges.h,
// seam-polyhedra.cc).  A cylinder is scaled down until it is apart: what is nearest then is no
// ghost (see buried_edge), and has its depth along that normal.
double manifold_at_seams(const Shape& a, const Frame& frame_a,
                         const std::vector<SeamNeighbour>& around_a, const Shape& b,
                         const Frame& frame_b, const std::vector<SeamNeighbour>& around_b,
                         double reach, double size, std::vector<ManifoldPoint>& out,
                         ReferenceChoice choice = ReferenceChoice::larger);

}  // namespace tw
