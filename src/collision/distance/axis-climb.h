// The axis of least penetration of two polyhedra that overlap little, by climbing.
//
// The faces of the Minkowski difference M = A - B are those of A (with the deepest vertex of B),
// those of B, and parallelograms of an edge of each.  The foot of the origin on the plane of a face
// either lies in the face: then no face beside it is nearer; or beyond one of its sides: then the
// face across that side is nearer.  Crossing a side turns the axis about an edge of one polyhedron
// until the next face of that one is reached, or the other's vertex gives way to a neighbour.
//
// Proof that the face found is the nearest of all: M holds a disc of the face about the foot
// (radius `room`) and a ball (the two inner balls' difference); where their convex hull holds the
// ball about the origin that touches the face, no other face is as near.
//
// Cost: a scan of the faces of each, two support queries, and mostly one to three steps.
//
// Frames: that of A's core.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/sat.h"

namespace tw {

enum class ClimbEnd {
  apart,   // the axis separates, and its distance is that of the polyhedra
  beyond,  // the axis separates; its distance is a lower bound
  proven,  // overlap; the axis is the one of least penetration
  local,   // overlap; the best axis about
  failed   // lost by rounding (edges nearly parallel): nothing is known
};

struct Climb {
  ClimbEnd end = ClimbEnd::failed;
  LeastAxis axis;
};

Climb climb_to_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a);

}  // namespace tw
