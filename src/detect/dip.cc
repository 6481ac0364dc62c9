// Dips between grid points.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/dip.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/interruption.h"
#include "detect/approach.h"

namespace tw {
namespace {

// How fast a surface point may be over the stretch, m/s.
double most_speed(const Body& body, const Trajectory& trajectory, double from, double to) {
  const MotionBounds bounds = trajectory.bounds(from, to);
  const Parabola* path = trajectory.ballistic();
  const double center =
      path ? std::max(path->velocity(from).norm(), path->velocity(to).norm()) : bounds.speed;
  return center + (bounds.turn > 0 ? bounds.turn * body.radius : 0);
}

}  // namespace

double first_dip(const Piece& piece, SimplexCaches& caches, double from, double to,
                 std::uint64_t& looks) {
  const double width = std::min(piece.body_a->least_width, piece.body_b->least_width);
  const double depth = answer::dip_share * width;
  const double speed = most_speed(*piece.body_a, piece.a->trajectory(), from, to) +
                       most_speed(*piece.body_b, piece.b->trajectory(), from, to);
  if (!(speed * (to - from) > depth)) return never;
  // no point gets from the surface to that depth and half as deep again between two of these times
  const double spacing = std::ldexp(1.0, std::ilogb(0.5 * depth / speed));
  const auto after = [&](double t) { return (std::floor(t / spacing) + 1) * spacing; };

  // of what turns so fast that its points run through a width in an instant there are billions
  constexpr std::uint64_t between_questions = 64;
  for (double t = from;;) {
    if (++looks % between_questions == 0) raise_if_interrupted();
    const double clear = certificate(piece, caches, t, depth);
    if (t > from && !(clear > t) && distance_at(piece, t) < -depth) return t;
    const double next = std::max(std::floor(clear / spacing) * spacing, after(t));
    // the end, or times have no finer digits
    if (!(next > t && next < to)) return never;
    t = next;
  }
}

}  // namespace tw
