// A plane that turns with the features that face each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/turning-plane.h"

#include <array>

#include "base/constants.h"
#include "detect/round-reach.h"
#include "geometry/polyhedron.h"

namespace tw {
namespace {

// Vertices this near the plane belong to the facing feature: times the distance, and share of the
// size.
constexpr double near_distances = 3, near_share = 1e-9;

// What of one body faces the other: a vertex or a point of what is round, an edge (counted as two),
// or a face.
struct Facing {
  int count = 0;
  Vec3 edge = Vec3::Zero();
};

// Of a frustum: a face is its end, an edge what of its side runs along the plane.
Facing facing_round(const Frame& frame, const ConvexPart& part, const Vec3& n, double depth) {
  Facing result;
  result.count = 1;
  if (part.kind != PartKind::frustum) return result;
  const Vec3 axis = frame.R.col(2);
  const double along = axis.dot(n);
  const Vec3 across = n - along * axis;
  const double sine = across.norm();
  // heights of the highest points of both ends, and of the lowest of the upper one
  const double upper = part.half_length * along, rise_of_upper = part.top_radius * sine,
               rise_of_lower = part.radius * sine;
  const bool on_upper = upper + rise_of_upper >= rise_of_lower - upper;
  const double drop_to_other = std::abs(2 * upper + rise_of_upper - rise_of_lower);
  const double radius = on_upper ? part.top_radius : part.radius;
  if (radius > 0 && 2 * radius * sine <= depth) {
    result.count = 3;
  } else if (part.half_length > 0 && drop_to_other <= depth && sine > 0) {
    result.count = 2;
    result.edge = 2 * part.half_length * axis + (part.top_radius - part.radius) / sine * across;
  }
  return result;
}

Facing facing(const Frame& frame, const ConvexPart& part, const Vec3& n, double top, double depth) {
  if (part.kind != PartKind::polyhedron) return facing_round(frame, part, n, depth);
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
  double pull = n.dot(relative) - n.cwiseAbs().dot(side.spread) - side.bend * radius -
                plane.turn * (2 * speed + plane.turn * distance + plane.until * change);

  // gap = n.(c - p), and its rate n.(u - v - w x (p - x)) + n'.(c - p), linear in p = R p_P + p_0
  const Vec3 m = n.cross(side.point.w);
  const Vec3 slope = -m - rate;
  const double gap0 = n.dot(plane.c - frame.p) + plane.allowance;
  double speed0 =
      n.dot(plane.u - side.point.v) + m.dot(side.point.x) + rate.dot(plane.c) + slope.dot(frame.p);
  const Vec3 n_P = frame.R.transpose() * n, slope_P = frame.R.transpose() * slope;
  double least = plane.until;
  if (part.kind != PartKind::polyhedron) {
    const bool ball = part.kind == PartKind::sphere;
    const double about = ball ? part.radius : part.margin;
    const double gap = gap0 - about - (ball ? 0 : round_top(part, n_P));
    // what is about the core lies |n + t rate| <= 1 + t n.rate + t^2 rate^2/2 as far along
    speed0 -= about * n.dot(rate);
    pull -= about * plane.turn * plane.turn;
    if (!(gap > 0)) return 0;
    return std::min(least, ball ? first_zero(gap, speed0, pull)
                                : round_reach(part, gap, speed0, pull, n_P, -slope_P));
  }
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
  return part.kind != PartKind::half_space && !side.by_speed;
}

double turning_time_apart(const MovingBody& a, const ConvexPart& part_a, const MovingBody& b,
                          const ConvexPart& part_b, const Separation& s, double allowance) {
  if (!(s.distance > 0)) return 0;
  const Frame frame_a = part_a.in(a.frame), frame_b = part_b.in(b.frame);
  const double depth =
      near_distances * s.distance + near_share * (part_a.bound_radius + part_b.bound_radius);
  const Facing on_a = facing(frame_a, part_a, s.normal, s.normal.dot(s.point_a), depth);
  const Facing on_b = facing(frame_b, part_b, -s.normal, -s.normal.dot(s.point_b), depth);

  if (on_a.count < 2 && on_b.count < 2) return 0;  // it does not turn

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
