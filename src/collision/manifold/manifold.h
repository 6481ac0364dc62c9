// Contact manifolds: the points at which two shapes touch or may touch soon, as features that a
// contact group can follow while the bodies move.
//
// Cold: a function of the two poses and the reach alone.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "base/constants.h"
#include "collision/manifold/contact-feature.h"
#include "geometry/shape.h"

namespace tw {

// A tangent plane is one that an ellipsoid of the other body, or its circle (`rim`), is followed on
// as it rolls; `curved` is a line (`direction`) or a point (`direction` 0), and one body's part, or
// both, an ellipsoid that is followed.  Points and radii are those of balls that osculate these.
struct ManifoldPoint {
  bool reference_is_a = true;  // the reference body; the other has the core point
  ContactFeature kind = ContactFeature::plane;
  Vec3 normal = Vec3::UnitZ();           // unit, world, from the reference body to the other
  Vec3 direction = Vec3::UnitX();        // unit, world: line, crossing, rim; curved: or 0
  Vec3 other_direction = Vec3::UnitY();  // unit, world: of the other body's line, or a rim's axis
  Vec3 rim_center = Vec3::Zero();        // world: where there is a rim
  Vec3 reference_point = Vec3::Zero();   // world: a point of the plane or line, or the core point
  Vec3 core_point = Vec3::Zero();        // world: of the other body
  double reference_radius = 0;           // m: of a spherical or cylindrical reference
  double radius = 0;                     // m: about the core point
  double rim = 0;                        // m: of the other body's rim; tangent plane: or 0
  double gap = 0;                        // m, signed; > 0: not yet touching
  // How flat it lies with the lowest points of its pair of parts: 1 as low, down to 0 where a line
  // to one of these, or the parts there, are no longer taken for parallel.  `beyond`: the sum of
  // that over the points that are farther than the reach, for each that is here.
  double flatness = 0, beyond = 0;
  int pair = 0;               // pair of parts, part_a * parts of b + part_b
  std::uint64_t feature = 0;  // stable while the same features meet

  // As two lines that cross, where they do (patch::crossing), through the points that are set;
  // world, of any length, or 0 where there is none.
  void follow_lines(const Vec3& of_reference, const Vec3& of_other);
};

// Which face is the reference where faces of both bodies could be.
enum class ReferenceChoice : unsigned char {
  larger,  // the one with more area; nearly equal: that of a
  of_a,    // that of a, as where a is fixed: contacts at its seams then have its very normals
  of_b,
};

// All points with gap <= reach of every pair of parts, appended to `out`: at least one for each
// pair of parts whose distance is <= reach.  Face against face: the clipped polygon and, of the
// incident body, the vertices that may come down on the reference face (*reach points*), the
// deepest always among them.  Ordered by pair of parts, then by feature.
void manifold(const Shape& a, const Frame& frame_a, const Shape& b, const Frame& frame_b,
              double reach, std::vector<ManifoldPoint>& out,
              ReferenceChoice choice = ReferenceChoice::larger);

}  // namespace tw
