// A plane that turns with the features that face each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/turning-plane.h"

#include <array>

#include "base/constants.h"
#include "geometry/polyhedron.h"

namespace tw {
namespace {

// Vertices this near the plane belong to the facing feature: times the distance, and share of the
// size.
constexpr double near_distances = 3, near_share = 1e-9;

// The vertices of one body that face the other: none, one, an edge (two of them), or a face.
struct Facing {
  int count = 0;
  Vec3 edge = Vec3::Zero();
};

Facing facing(const Frame& frame, const ConvexPart& part, const Vec3& n, double top, double depth) {
  Facing result;
  // heights in the part's frame
  const Vec3 n_P = frame.R.transpose() * n;
  const double least = top - depth - n.dot(frame.p);
  Vec3 first = Vec3::Zero();
  for (const Vec3& vertex : part.core->vertices()) {
    if (n_P.dot(vertex) < least) continue;
    if (result.count == 0) first = vertex;
    if (result.count == 1) result.edge = frame.R * (vertex - first);
    if (++result.count > 2) break;
  }
  return result;
}

// The rate of n that keeps an edge of each at its height: n'.e = -n.(w x e) for both.
Vec3 rate_of_normal(const Vec3& n, const Facing& a, const Vec3& w_a, const Facing& b,
                    const Vec3& w_b) {
  if (a.count > 2) return w_a.cross(n);
  if (b.count > 2) return w_b.cross(n);
  const double ra = a.count == 2 ? -n.dot(w_a.cross(a.edge)) : 0;
  const double rb = b.count == 2 ? -n.dot(w_b.cross(b.edge)) : 0;
  const double aa = a.edge.squaredNorm(), bb = b.edge.squaredNorm(), ab = a.edge.dot(b.edge);
  const double det = aa * bb - ab * ab;
  constexpr double parallel = 1e-6;
  if (a.count == 2 && b.count == 2 && det > parallel * aa * bb)
    return ((ra * bb - rb * ab) / det) * a.edge + ((rb * aa - ra * ab) / det) * b.edge;
  if (a.count == 2) return (ra / aa) * a.edge;
  if (b.count == 2) return (rb / bb) * b.edge;
  return Vec3::Zero();
}

struct TurningPlane {
  Vec3 n, rate, c, u, acceleration;
  double allowance, turn, until;
};

// When a vertex of the part may reach the plane; `sign` +1: it lies below, -1: above.
double time_to_reach(const MovingBody& side, const Frame& frame, const ConvexPart& part,
                     const TurningPlane& plane, double sign) {
  const Vec3 n = sign * plane.n, rate = sign * plane.rate;
  const double radius = side.body->radius;
  const Vec3 relative = plane.acceleration - side.acceleration;
  const double change = relative.norm() + side.spread.norm() + side.bend * radius;
  const double speed =
      (plane.u - side.point.v).norm() + side.point.w.norm() * radius + change * plane.until;
  const double distance = (plane.c - side.point.x).norm() + radius;
  const double pull = n.dot(relative) - n.cwiseAbs().dot(side.spread) - side.bend * radius -
                      plane.turn * (2 * speed + plane.turn * distance + plane.until * change);

  // gap = n.(c - p), and its rate n.(u - v - w x (p - x)) + n'.(c - p), linear in p = R p_P + p_0
  const Vec3 m = n.cross(side.point.w);
  const Vec3 slope = -m - rate;
  const double gap0 = n.dot(plane.c - frame.p) + plane.allowance;
  const double speed0 =
      n.dot(plane.u - side.point.v) + m.dot(side.point.x) + rate.dot(plane.c) + slope.dot(frame.p);
  const Vec3 n_P = frame.R.transpose() * n, slope_P = frame.R.transpose() * slope;
  double least = plane.until;
  for (const Vec3& vertex : part.core->vertices()) {
    const double gap = gap0 - n_P.dot(vertex);
    if (!(gap > 0)) return 0;
    const double closing = speed0 + slope_P.dot(vertex);
    if (pull <= 0 && gap + least * (closing + 0.5 * pull * least) > 0) continue;
    least = std::min(least, first_zero(gap, closing, pull));
  }
  return least;
}

}  // namespace

bool can_turn(const MovingBody& side, const ConvexPart& part) {
  return part.kind == PartKind::polyhedron && !side.by_speed;
}

double turning_time_apart(const MovingBody& a, const ConvexPart& part_a, const MovingBody& b,
                          const ConvexPart& part_b, const Separation& s, double allowance) {
  if (!(s.distance > 0)) return 0;
  const Frame frame_a = a.frame * part_a.placement, frame_b = b.frame * part_b.placement;
  const double depth =
      near_distances * s.distance + near_share * (part_a.bound_radius + part_b.bound_radius);
  const Facing on_a = facing(frame_a, part_a, s.normal, s.normal.dot(s.point_a), depth);
  const Facing on_b = facing(frame_b, part_b, -s.normal, -s.normal.dot(s.point_b), depth);

  TurningPlane plane;
  plane.n = s.normal;
  plane.rate = rate_of_normal(s.normal, on_a, a.point.w, on_b, b.point.w);
  plane.c = 0.5 * (s.point_a + s.point_b);
  plane.u = 0.5 * (a.velocity_at(s.point_a) + b.velocity_at(s.point_b));
  plane.acceleration = 0.5 * (a.acceleration + b.acceleration);
  plane.allowance = 0.5 * allowance;
  plane.turn = plane.rate.norm();
  plane.until = cost::longest_turn;
  const double below = time_to_reach(a, frame_a, part_a, plane, 1);
  if (!(below > 0)) return 0;
  return std::min(below, time_to_reach(b, frame_b, part_b, plane, -1));
}

}  // namespace tw
