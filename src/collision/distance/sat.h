// Touching and overlapping polyhedra: the axis of least penetration, exactly.
//
// The signed distance along a unit axis n (from A to B) is s(n) = min over B of n.x - max over A of
// n.x.  For overlapping polyhedra the greatest s(n) is at a face normal of A or B or at the cross
// product of an edge of each whose arcs of normals cross on the Gauss map; then -s(n) is the least
// translation that separates them.
//
// Every s(n) is measured by support points, so that it never exceeds the true maximum: a badly
// determined axis can lose but never win.  At ties within 1e-13 of the size a face of A precedes a
// face of B, which precedes edges; faces and edges in the order of their numbers, except that the
// face most opposite the other's centre comes first.
//
// Source: D. Gregorius, "The separating axis test between convex polyhedra" (GDC 2013) for the test
// on the Gauss map.
// Cost: faces of each times a support query of the other, and pairs of edges near the contact.
//
// Frames: that of A's core.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "geometry/polyhedron.h"

namespace tw {

enum class AxisKind { face_a, face_b, edges };

struct LeastAxis {
  AxisKind kind = AxisKind::face_a;
  double distance = 0;          // m, the greatest s(n)
  Vec3 normal = Vec3::UnitZ();  // unit, from A to B
  int feature_a = 0;            // face or edge of A; for face_b a support vertex of A
  int feature_b = 0;            // face or edge of B; for face_a a support vertex of B
};

// `b_in_a` maps B's frame to A's.  `gap` is the distance where it is known to be positive: edges
// farther apart than that cannot matter; 0 for overlap.  `known`, if any, is an axis to begin with:
// the better it is, the less is left to search; it stays at ties.
LeastAxis least_axis(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a, double gap,
                     const LeastAxis* known = nullptr);

// Nearest points of the lines through two segments p + s u and q + t v, s and t within 0..1.
// Parallel lines: some pair of nearest points.
void nearest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v, Vec3& on_u,
                         Vec3& on_v);

}  // namespace tw
