// Clearance: whether a pair is surely apart for a whole window.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/clearance.h"

#include <algorithm>

namespace tw {
namespace {

// How a body moves over a window: its centre along the chord of its path, evenly, but for what the
// path's bend takes it off (|x''| T^2/8 at most), and how far turning carries its surface beyond.
// Where no accelerations are known, by the box of its path alone.
struct Travel {
  Vec3 center = Vec3::Zero();
  Vec3 chord = Vec3::Zero();
  Aabb off{Vec3::Zero(), Vec3::Zero()};
  double turning = 0;
};

Travel travel_of(const Body& body, const Trajectory& trajectory, double from, double to) {
  const MotionBounds bounds = trajectory.bounds(from, to);
  const double length = to - from;
  Travel t;
  t.center = trajectory.center(from);
  t.turning = body.sphere_radius >= 0 ? 0 : bounds.turn * length * body.radius;
  if (bounds.velocity_may_jump() || bounds.valid_until < to) {
    t.off = {bounds.path.lo - t.center, bounds.path.hi - t.center};
    return t;
  }
  t.chord = trajectory.center(to) - t.center;
  const Aabb& pull = bounds.acceleration;
  const Vec3 most = (0.125 * length * length) * pull.lo.cwiseAbs().cwiseMax(pull.hi.cwiseAbs());
  t.off = {-most, most};
  return t;
}

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
