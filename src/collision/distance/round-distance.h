// Signed distance of two convex cores of which at least one is a frustum or an ellipsoid, and of
// what is within the margins of them.
//
// Apart: GJK with support points, until the support plane proves that no more than 1e-13 of the
// size can be gained.  Touching or overlapping: B is moved in until it overlaps surely, and the
// expanding polytope gives the axis of least depth; the distance is then measured along that axis
// at the true place.  Axes next to a face normal, a cap's or that of a frustum's side are replaced
// by these exactly where nothing is lost.  With an ellipsoid both end early, and the axis is found
// from there by smooth-axis.h.
//
// Accuracy: 1e-12 of the size; normals 1e-6 rad, and to rounding where a face, cap or side decides.
// Cost: 0.3 to 2 us apart, 2 to 30 us in overlap.
//
// Frames: that of both cores' placement.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "collision/distance/support-core.h"

namespace tw {

struct RoundDistance {
  double distance = 0;          // m, signed
  Vec3 normal = Vec3::UnitZ();  // unit, from A to B
  Vec3 point_a = Vec3::Zero();  // witnesses: point_b - point_a = distance * normal
  Vec3 point_b = Vec3::Zero();
};

RoundDistance round_distance(const SupportCore& a, const SupportCore& b);

// s(n) = min over B of n.x - max over A of n.x, of the cores.
double distance_along(const SupportCore& a, const SupportCore& b, const Vec3& normal);

}  // namespace tw
