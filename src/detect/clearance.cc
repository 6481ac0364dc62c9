// Clearance: whether a pair is surely apart for a whole window.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/clearance.h"

#include <algorithm>

#include "base/constants.h"
#include "collision/broad/near-parts.h"

namespace tw {
namespace {

// What the centres' ways may do to the distance of two surface points: what they have in common
// does nothing.
struct RelativeTravel {
  Vec3 chord;   // of b against a
  Vec3 lo, hi;  // off it
  double turning;

  RelativeTravel(const Travel& a, const Travel& b)
      : chord(b.chord - a.chord),
        lo(b.off.lo - a.off.hi),
        hi(b.off.hi - a.off.lo),
        turning(a.turning + b.turning) {}
  // in any direction
  double most() const {
    return chord.norm() + lo.cwiseAbs().cwiseMax(hi.cwiseAbs()).norm() + turning;
  }
  // against the unit normal n from a to b
  double against(const Vec3& n) const {
    double closing = std::max(-n.dot(chord), 0.0);
    for (int i = 0; i < 3; ++i) closing += std::max(-n[i] * lo[i], -n[i] * hi[i]);
    return std::max(closing, 0.0) + turning;
  }
};

}  // namespace

bool apart_throughout(const Piece& piece, Clearance& known, SimplexCaches& caches, double from,
                      double to, const Travels& travels, SeenApart* seen) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  if (a.unbounded || b.unbounded) return false;
  const Travel ta = travels.of(a, *piece.a, from, to), tb = travels.of(b, *piece.b, from, to);
  const RelativeTravel travel(ta, tb);

  // remembered, or by the bounding balls, or by a query: what is left of it at the end
  const bool remembered = known.from <= from && from <= known.until;
  const double balls = (tb.center - ta.center).norm() - a.radius - b.radius;
  const double least = answer::apart_in_roundings * distance_rounding(a, ta.center, b, tb.center);
  double left = std::max(remembered ? known.distance : 0, balls) - travel.most();
  if (!(left > least)) {
    const Frame fa = piece.a->trajectory().frame(from), fb = piece.b->trajectory().frame(from);
    const Shape& shape_a = *a.shape_P;
    const Shape& shape_b = *b.shape_P;
    const std::size_t pairs = shape_a.part_count() * shape_b.part_count();
    left = never;
    const auto look = [&](std::size_t i, std::size_t j) {
      if (!(left > least)) return;
      SimplexCache& cache = caches.of(i * shape_b.part_count() + j, pairs);
      const Separation s = part_separation(shape_a.part(i), fa, shape_b.part(j), fb, &cache);
      left = std::min(left, s.distance - travel.against(s.normal));
      if (seen && pairs == 1) *seen = {from, s};
    };
    if (shape_a.tree() || shape_b.tree()) {
      // what is farther than this is not looked at: some times the way, and of what hardly moves a
      // share of its size
      const double farthest =
          std::max(4 * travel.most(), 0.05 * std::min(a.least_width, b.least_width));
      left = farthest - travel.most();
      visit_near_parts(shape_a, fa, shape_b, fb, farthest, look);
    } else {
      for (std::size_t i = 0; i < shape_a.part_count() && left > least; ++i)
        for (std::size_t j = 0; j < shape_b.part_count() && left > least; ++j) look(i, j);
    }
  }
  if (!(left > least)) return false;
  known = {left, from, to};
  return true;
}

}  // namespace tw
