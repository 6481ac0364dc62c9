// The visible faces of half-spaces: large polygons, each cut where another half-space is solid.
//
// So six half-spaces that enclose a room show its walls, and none of what lies beyond them; and a
// wall is not drawn when seen from inside its solid, so that one looks into the room.
//
// Cost: every pair of half-spaces once per frame.
// Source: clipping by I. Sutherland and G. Hodgman, Reentrant polygon clipping (1974).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "math/aabb.h"
#include "render/draw-list.h"

namespace tw {

struct HalfSpacePolygon {
  std::size_t body = 0;
  Vec3 normal = Vec3::UnitZ();  // out of the solid, unit, world
  Vec3 origin = Vec3::Zero();   // a point of the plane that moves with the body, world
  Vec3 u = Vec3::UnitX(), v = Vec3::UnitY();  // axes of the plane, moving with the body
  std::vector<Vec3> corners;                  // counter-clockwise seen from outside, world
};

// All visible faces; an unbounded one reaches `reach` metres to each side of `center`.  A
// half-space that is not visible cuts the others all the same.  Bodies whose pose is not finite are
// left out.
std::vector<HalfSpacePolygon> half_space_polygons(std::span<const DrawBody> bodies,
                                                  std::span<const Pose> poses, const Vec3& center,
                                                  double reach);

// Grows `bounds` by the corners in which three half-space faces meet.
void add_enclosed_room(std::span<const DrawBody> bodies, std::span<const Pose> poses, Aabb& bounds);

}  // namespace tw
