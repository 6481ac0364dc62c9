// When a round part may reach a plane that stands or turns: frustums, ellipsoids and balls.
//
// The height of the points p of a part above a plane that it moves against is linear in them, and
// so is its rate: n.p + s m.p after s.  Of all its points the highest is at round_top(n + s m).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "detect/moving-body.h"
#include "geometry/shape.h"

namespace tw {

// How high the core of a round part reaches along a direction in its frame, above its middle.
inline double round_top(const ConvexPart& part, const Vec3& along) {
  if (part.kind == PartKind::ellipsoid) return part.semi_axes.cwiseProduct(along).norm();
  const double across = std::hypot(along.x(), along.y()), up = part.half_length * along.z();
  return std::max(up + part.top_radius * across, part.radius * across - up);
}

// When a round part `gap` > 0 below the plane may reach it, but for its turning at the rate `rate`
// and the pull `pull`.  Its top, round_top(n + s m), is convex: over [0, S] it rises by no more
// than the chord's slope, at most round_top(m).  Long chords count what goes up at one end only
// once it is the top: what stands on the plane along a line or on a face, and turns off it, is not
// there at once.
inline double round_reach(const ConvexPart& part, double gap, double rate, double pull,
                          const Vec3& n, const Vec3& m) {
  constexpr double longer = 4;
  const double top = round_top(part, n);
  double reached = first_zero(gap, rate - round_top(part, m), pull);
  while (reached < cost::soon) {
    const double to = longer * reached, slope = (round_top(part, n + to * m) - top) / to;
    const double least = std::min(to, first_zero(gap, rate - slope, pull));
    if (!(least > reached)) break;
    reached = least;
  }
  return reached;
}

}  // namespace tw
