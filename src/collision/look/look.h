// A look at two convex parts on the move: the points at which they touch or may touch soon.
//
// As collision/manifold, for bodies that are looked at again and again: a look begins where the
// last one ended, and what it found is handed on with the pair.  A look is a function of the two
// poses, the reach and that memory; who hands the memory on from arc to arc gets the same bits
// wherever arcs begin.
//
// Points are told in the frames of the two shapes, for they are followed as the bodies move: a
// plane of the one (the *reference*) and a core point of the other, with a radius about it,
//   gap = normal.x - offset - radius,  x the core point in the frame of the reference.
// Of a curved surface the plane is the tangent one: it holds as long as the bodies hardly turn.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "collision/distance/sat.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold.h"
#include "geometry/shape.h"

namespace tw {

// Where the last look at a pair of parts ended.
struct PairMemory {
  Vec3 axis = Vec3::Zero();  // unit, from a to b, in the part frame of a; zero: none
  SimplexCache simplex;      // GJK's last one
  bool is_sunk = false;      // and by that axis:
  LeastAxis least;
  int support_a = 0, support_b = 0;  // vertices farthest along the axis, and against it
  int face_a = -1, face_b = -1;      // faces most along it, and against it; -1: not looked for
};

struct LookPoint {
  bool reference_is_a = true;
  Vec3 normal = Vec3::UnitZ();  // unit, away from the reference, in the frame of its shape
  double offset = 0;            // m
  Vec3 core = Vec3::Zero();     // m, in the frame of the other shape
  double radius = 0;            // m
  double gap = 0;               // m, signed; > 0: not yet touching
  std::uint64_t feature = 0;    // stable while the same features meet
};

inline constexpr int most_look_points = 16;

struct PartLook {
  double distance = 0;  // m: of the nearest points, or, above the reach, a lower bound of it
  // unit, world, from a to b: along it they are that far apart; zero: any
  Vec3 axis = Vec3::Zero();
  int count = 0;
  // Whether all points are vertices of the one over one face of the other: they stay the same as
  // the one slides along that plane by `room`, m.
  bool on_face = false;
  double room = 0;
  std::array<LookPoint, most_look_points> points;

  void add(const LookPoint& point) {
    if (count < most_look_points) points[static_cast<std::size_t>(count++)] = point;
  }
};

// `frame_a`, `frame_b`: of the shapes.  Overwrites all of `look` but the points beyond its count.
void look_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b, const Frame& frame_b,
             double reach, ReferenceChoice choice, PairMemory& memory, PartLook& look);

}  // namespace tw
