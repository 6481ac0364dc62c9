// Clearance: whether a pair is surely apart for a whole window.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/clearance.h"

#include <algorithm>

namespace tw {
namespace {

// Where a body's centre may get to from where it is, and how far turning carries its surface
// beyond.
struct Travel {
  Vec3 center = Vec3::Zero();
  Aabb displacement{Vec3::Zero(), Vec3::Zero()};
  double turning = 0;
};

Travel travel_of(const Body& body, const Trajectory& trajectory, double from, double to) {
  const MotionBounds bounds = trajectory.bounds(from, to);
  Travel t;
  t.center = trajectory.center(from);
  t.displacement = {bounds.path.lo - t.center, bounds.path.hi - t.center};
  t.turning = body.sphere_radius >= 0 ? 0 : bounds.turn * (to - from) * body.radius;
  return t;
}

// What the centres' displacements may do to the distance of two surface points.
struct RelativeTravel {
  Vec3 lo, hi;  // of b against a
  double turning;

  RelativeTravel(const Travel& a, const Travel& b)
      : lo(b.displacement.lo - a.displacement.hi),
        hi(b.displacement.hi - a.displacement.lo),
        turning(a.turning + b.turning) {}
  // in any direction
  double most() const { return lo.cwiseAbs().cwiseMax(hi.cwiseAbs()).norm() + turning; }
  // against the unit normal n from a to b
  double against(const Vec3& n) const {
    double closing = 0;
    for (int i = 0; i < 3; ++i) closing += std::max(-n[i] * lo[i], -n[i] * hi[i]);
    return std::max(closing, 0.0) + turning;
  }
};

}  // namespace

bool apart_throughout(const Piece& piece, Clearance& known, SimplexCaches& caches, double from,
                      double to) {
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  if (a.unbounded || b.unbounded) return false;
  const Trajectory& path_a = piece.a->trajectory();
  const Trajectory& path_b = piece.b->trajectory();
  const Travel ta = travel_of(a, path_a, from, to), tb = travel_of(b, path_b, from, to);
  const RelativeTravel travel(ta, tb);

  // remembered, or by the bounding balls, or by a query: what is left of it at the end
  const bool remembered = known.from <= from && from <= known.until;
  const double balls = (tb.center - ta.center).norm() - a.radius - b.radius;
  const double rounding = distance_rounding(a, ta.center, b, tb.center);
  double left = std::max(remembered ? known.distance : 0, balls) - travel.most();
  if (!(left > rounding)) {
    const Frame fa = path_a.frame(from), fb = path_b.frame(from);
    const auto& parts_a = a.shape_P->parts();
    const auto& parts_b = b.shape_P->parts();
    if (caches.empty()) caches.resize(parts_a.size() * parts_b.size());
    left = never;
    for (std::size_t i = 0; i < parts_a.size() && left > rounding; ++i)
      for (std::size_t j = 0; j < parts_b.size() && left > rounding; ++j) {
        const Separation s =
            part_separation(parts_a[i], fa, parts_b[j], fb, &caches[i * parts_b.size() + j]);
        left = std::min(left, s.distance - travel.against(s.normal));
      }
  }
  if (!(left > rounding)) return false;
  known = {left, from, to};
  return true;
}

}  // namespace tw
