// Signed distance of cores by support points.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/round-distance.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/expanding-polytope.h"
#include "collision/distance/frustum-point.h"
#include "collision/distance/simplex.h"
#include "collision/distance/smooth-axis.h"

namespace tw {

namespace {

// what the distance may err by, relative to the size
constexpr double apart_accuracy = 1e-13;
constexpr double depth_accuracy = 1e-12;

// the same where an axis that errs little leads to the best one; that of an edge is soon left;
// depths relative to half the width of the thinner one
constexpr double smooth_accuracy = 1e-5, smooth_on_edges = 1e-9;

// below this distance, relative to the size, GJK's direction is not trusted
constexpr double round_touch = 1e-7, smooth_touch = 1e-4;

// how far B is moved in for the polytope, relative to the size
constexpr double push = 1e-6;

// what a plain axis must gain on the polytope's for its own witness points, relative to the size
constexpr double lost_depth = 1e-9;

// how far witness points may be outside before others are tried, relative to the size
constexpr double on_surface = 1e-7;

// special axes this near are tried, rad; where an axis may err
constexpr double special = 1e-3, smooth_special = 0.05;

// GJK's end.
struct Descent {
  bool overlap = false;
  Simplex simplex;
  std::vector<DifferencePoint> seen;  // what the simplex' numbers mean: all there ever were

  const DifferencePoint& point(std::size_t i) const {
    return seen[static_cast<std::size_t>(simplex.points[i].a)];
  }
};

void add_point(Descent& d, const DifferencePoint& p) {
  const int number = static_cast<int>(d.seen.size());
  d.seen.push_back(p);
  d.simplex.points[static_cast<std::size_t>(d.simplex.count++)] = {p.w, number, number};
}

bool in_simplex(const Simplex& simplex, const Vec3& w) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
    if (simplex.points[i].w == w) return true;
  return false;
}

bool has_ellipsoid(const SupportCore& a, const SupportCore& b) {
  return a.kind == PartKind::ellipsoid || b.kind == PartKind::ellipsoid;
}

Descent descend(const SupportCore& a, const SupportCore& b, const Vec3& shift,
                double accuracy = apart_accuracy) {
  constexpr int most_steps = 200, most_stalls = 6;
  Descent d;
  const double size = a.size() + b.size();
  add_point(d, difference_support(a, b, shift, b.center() + shift - a.center()));
  reduce(d.simplex);
  Simplex best = d.simplex;
  double least = best.v.squaredNorm();
  for (int step = 0, stalls = 0; step < most_steps && stalls < most_stalls; ++step) {
    const Vec3 v = d.simplex.v;
    const double square = v.squaredNorm();
    if (!(square > 0)) break;
    const DifferencePoint next = difference_support(a, b, shift, -v);
    // |v| - v.w/|v| bounds what can still be gained
    const double gain = square - v.dot(next.w);
    if (gain <= accuracy * size * std::sqrt(square) || in_simplex(d.simplex, next.w)) break;
    add_point(d, next);
    if (reduce(d.simplex)) {
      d.overlap = true;
      return d;
    }
    const double reached = d.simplex.v.squaredNorm();
    if (reached < least) {
      least = reached;
      best = d.simplex;
    } else {
      ++stalls;
    }
  }
  d.simplex = best;
  return d;
}

// The normal of a frustum's side next to n, outward from the core where `sign` is 1.
Vec3 side_normal(const SupportCore& core, double sign, const Vec3& n) {
  const Vec3 axis = core.axis();
  const Vec3 out = (n - axis.dot(n) * axis).normalized();
  if (!narrows(core)) return out;
  const SideNormal side(core);
  return side.across * out + sign * side.along * axis;
}

// Special axes next to n of one core (outward from it), appended.
void add_special(const SupportCore& core, const Vec3& n, double sign, double within,
                 std::vector<Vec3>& out) {
  const auto offer = [&](const Vec3& axis) {
    if ((axis - n).squaredNorm() < within * within) out.push_back(axis);
  };
  if (core.polyhedron != nullptr) {
    const Vec3 local = sign * (core.place.R.transpose() * n);
    const int vertex = core.polyhedron->support(local, 0);
    const int face = core.polyhedron->face_at_vertex(vertex, local);
    return offer(sign * (core.place.R * core.polyhedron->face(face).normal));
  }
  if (core.kind == PartKind::ellipsoid) return;
  const Vec3 axis = core.axis();
  const double along = axis.dot(n);
  offer(along < 0 ? Vec3(-axis) : axis);
  offer(side_normal(core, sign, n));
}

// The special axis that loses nothing against `distance`, if any.
Vec3 refined(const SupportCore& a, const SupportCore& b, const Vec3& n, double distance) {
  thread_local std::vector<Vec3> axes;
  axes.clear();
  const double within = has_ellipsoid(a, b) ? smooth_special : special;
  add_special(a, n, 1, within, axes);
  add_special(b, n, -1, within, axes);
  const double allowed = distance - 2 * depth_accuracy * (a.size() + b.size());
  for (const Vec3& axis : axes)
    if (distance_along(a, b, axis) >= allowed) return axis;
  return n;
}

RoundDistance apart_at(const Descent& d) {
  RoundDistance result;
  result.distance = d.simplex.v.norm();
  result.normal = -d.simplex.v / result.distance;
  for (std::size_t i = 0; i < static_cast<std::size_t>(d.simplex.count); ++i)
    result.point_a += d.simplex.lambda[i] * d.point(i).on_a;
  return result;
}

// The overlap along any axis bounds the depth: the best of those by which GJK parted the two, if it
// did, and of a round core's own.  Where drums touch end to end or lie in each other with parallel
// axes the polytope has no volume to begin with, and ends anywhere.
Vec3 best_plain_axis(const SupportCore& a, const SupportCore& b, const Descent& first) {
  const Vec3 between = b.center() - a.center();
  Vec3 best = between.norm() > 0 ? Vec3(between.normalized()) : Vec3(Vec3::UnitZ());
  double most = distance_along(a, b, best);
  const auto offer = [&](const Vec3& axis) {
    const double norm = axis.norm();
    if (!(norm > 0)) return;
    const Vec3 n = axis / norm;
    const double distance = distance_along(a, b, n);
    if (distance > most) {
      most = distance;
      best = n;
    }
  };
  if (!first.overlap) offer(-first.simplex.v);
  for (const SupportCore* core : {&a, &b}) {
    if (core->kind != PartKind::frustum) continue;
    const Vec3 axis = core->axis();
    const double along = axis.dot(between);
    offer(along < 0 ? Vec3(-axis) : axis);
    offer(between - along * axis);
  }
  return best;
}

// Between the points of both that are farthest along the normal, on the plane of A's.
Vec3 touch_along(const SupportCore& a, const SupportCore& b, const Vec3& normal) {
  const Vec3 on_a = a.support(normal), middle = 0.5 * (on_a + b.support(-normal));
  return middle + normal.dot(on_a - middle) * normal;
}

// The signed height of a point over a core, m.
double height_over(const SupportCore& core, const Vec3& point) {
  const Vec3 local = core.place.to_local(point);
  int face = 0;
  if (core.polyhedron != nullptr) return core.polyhedron->face_separation(local, face);
  if (core.kind == PartKind::ellipsoid) return nearest_on_ellipsoid(core.semi_axes, local).distance;
  return nearest_on_frustum(core, local).distance + core.margin;
}

// From the axis given to the best one near by, and that if it is better than the result.
void improve(const SupportCore& a, const SupportCore& b, const Vec3& start, RoundDistance& result) {
  const SmoothAxis near = climb_smooth(a, b, start);
  const Vec3 axis = refined(a, b, near.normal, near.distance);
  const double distance = distance_along(a, b, axis);
  if (distance < result.distance) return;
  result.normal = axis;
  result.distance = distance;
}

// Of several points of A the one that is least outside of both, with the one across it on B.  The
// polytope's foot, and the middle of two farthest points, may be on neither where a tip or a thin
// rim touches: the axis has other farthest points then.
void choose_witness(const SupportCore& a, const SupportCore& b, std::initializer_list<Vec3> others,
                    RoundDistance& result) {
  const Vec3 across = result.distance * result.normal;
  const auto outside = [&](const Vec3& point) {
    return std::max(height_over(a, point), height_over(b, point + across));
  };
  double least = outside(result.point_a);
  if (least <= on_surface * (a.size() + b.size())) return;
  for (const Vec3& point : others)
    if (const double there = outside(point); there < least) {
      least = there;
      result.point_a = point;
    }
}

RoundDistance overlapping(const SupportCore& a, const SupportCore& b, Descent d) {
  const double size = a.size() + b.size();
  const Vec3 plain = best_plain_axis(a, b, d);
  // the middle of two farthest points is on neither where one is a tip: there GJK's witness is kept
  const auto is_cone = [](const SupportCore& core) {
    return core.kind == PartKind::frustum && narrows(core);
  };
  const bool apart = !d.overlap && d.simplex.v.norm() > 0;
  const bool parted = apart && (is_cone(a) || is_cone(b));
  const Vec3 parting_point = apart ? apart_at(d).point_a : a.center();
  // Moved in a little, more where rounding asks for it; a little aside, out of planes of symmetry.
  // Where they touch to rounding GJK's direction is noise and may part them: towards the other's
  // centre whatever touches overlaps, if it is not moved aside and out, as along a wide floor.
  const Vec3 aside(0.048, 0.06, 0.064);
  const double gap = d.overlap ? 0 : d.simplex.v.norm();
  const Vec3 between = a.center() - b.center();
  const Vec3 central = between.norm() > 0 ? Vec3(between.normalized()) : Vec3(Vec3::UnitZ());
  const Vec3 shortest = gap > 0 ? Vec3(d.simplex.v / gap) : central;
  const std::array<std::pair<Vec3, Vec3>, 4> ways{
      {{shortest, aside}, {central, aside}, {central, -aside}, {shortest, -aside}}};
  Vec3 shift = Vec3::Zero();
  for (double more = push * size; !d.overlap && more < size; more *= 10)
    for (std::size_t i = 0; !d.overlap && i < ways.size(); ++i) {
      const auto& [inward, oblique] = ways[i];
      shift = gap * inward + more * (inward + oblique);
      d = descend(a, b, shift);
    }
  RoundDistance result;
  const auto offer_witnesses = [&] {
    const Vec3 n = result.normal;
    choose_witness(a, b, {parting_point, a.support(n), b.support(-n) - result.distance * n},
                   result);
  };
  if (!d.overlap) {
    result.normal = plain;
    result.distance = distance_along(a, b, plain);
    result.point_a = touch_along(a, b, plain);
    offer_witnesses();
    return result;
  }
  double tolerance = depth_accuracy * size;
  if (has_ellipsoid(a, b)) {
    const bool edges = a.polyhedron != nullptr || b.polyhedron != nullptr;
    const double thickness = std::min(a.half_width(), b.half_width());
    tolerance = std::max((edges ? smooth_on_edges : smooth_accuracy) * thickness, tolerance);
  }
  const PolytopeDepth found =
      polytope_depth(a, b, shift, {d.point(0), d.point(1), d.point(2), d.point(3)}, tolerance);
  result.normal = refined(a, b, found.normal, distance_along(a, b, found.normal));
  result.distance = distance_along(a, b, result.normal);
  result.point_a = found.on_a;
  // where rounding ended the polytope before it was sure, on from its axis and from the plain one
  if (found.uncertainty > 2 * tolerance) {
    const double before = result.distance;
    for (const Vec3& start : {found.normal, plain}) improve(a, b, start, result);
    if (result.distance > before + lost_depth * size)
      result.point_a = touch_along(a, b, result.normal);
  }
  // any axis along which they overlap less is nearer to the truth; where they touch along a line or
  // end to end the polytope's errs by its accuracy, and nothing that slides there would be apart
  if (const double bound = distance_along(a, b, plain); bound > result.distance) {
    if (bound > result.distance + lost_depth * size)
      result.point_a = parted ? parting_point : touch_along(a, b, plain);
    result.normal = plain;
    result.distance = bound;
  }
  offer_witnesses();
  return result;
}

// The farthest point of A along the normal that B is over: an ellipsoid's own or under an
// ellipsoid's; what else is flat there has others.
Vec3 witness_of_smooth(const SupportCore& a, const SupportCore& b, const Vec3& normal,
                       double distance) {
  if (a.kind == PartKind::ellipsoid) return a.support(normal);
  return b.support(-normal) - distance * normal;
}

// Whether the ellipsoid's farthest point and one of the other are no farther apart than the
// separation along the normal.
bool is_proved(const SupportCore& a, const SupportCore& b, const Vec3& normal, double distance) {
  const double allowed = apart_accuracy * (a.size() + b.size());
  if (!(distance > 0)) return false;
  if (a.kind == PartKind::ellipsoid)
    return height_over(b, a.support(normal) + distance * normal) <= allowed;
  return height_over(a, b.support(-normal) - distance * normal) <= allowed;
}

// With an ellipsoid.
RoundDistance smooth_distance(const SupportCore& a, const SupportCore& b) {
  const double size = a.size() + b.size();
  Descent d = descend(a, b, Vec3::Zero(), smooth_accuracy);
  RoundDistance result;
  result.distance = -std::numeric_limits<double>::infinity();
  if (!d.overlap && d.simplex.v.norm() > smooth_touch * size) {
    improve(a, b, -d.simplex.v.normalized(), result);
    if (!is_proved(a, b, result.normal, result.distance)) {
      d = descend(a, b, Vec3::Zero());
      improve(a, b, apart_at(d).normal, result);
    }
  } else {
    // a thin one in touch: what parts the two may be far from the axis that the polytope ends at
    const Descent exact = d.overlap ? d : descend(a, b, Vec3::Zero());
    if (!exact.overlap && exact.simplex.v.norm() > 0) improve(a, b, apart_at(exact).normal, result);
    if (!is_proved(a, b, result.normal, result.distance)) {
      RoundDistance deep = overlapping(a, b, d);
      improve(a, b, deep.normal, deep);
      if (!(result.distance > deep.distance)) result = deep;
    }
  }
  result.point_a = witness_of_smooth(a, b, result.normal, result.distance);
  result.point_b = result.point_a + result.distance * result.normal;
  return result;
}

// All points within the margins.
RoundDistance grown(RoundDistance core, const SupportCore& a, const SupportCore& b) {
  if (a.margin == 0 && b.margin == 0) return core;
  core.distance -= a.margin + b.margin;
  core.point_a += a.margin * core.normal;
  core.point_b -= b.margin * core.normal;
  return core;
}

RoundDistance core_distance(const SupportCore& a, const SupportCore& b) {
  if (has_ellipsoid(a, b)) return smooth_distance(a, b);
  const double size = a.size() + b.size();
  const Descent d = descend(a, b, Vec3::Zero());
  RoundDistance result;
  if (!d.overlap && d.simplex.v.norm() > round_touch * size) {
    result = apart_at(d);
    const Vec3 axis = refined(a, b, result.normal, result.distance);
    if (axis != result.normal) result.distance = distance_along(a, b, axis);
    result.normal = axis;
  } else {
    result = overlapping(a, b, d);
  }
  result.point_b = result.point_a + result.distance * result.normal;
  return result;
}

}  // namespace

double distance_along(const SupportCore& a, const SupportCore& b, const Vec3& normal) {
  return normal.dot(b.support(-normal) - a.support(normal));
}

RoundDistance round_distance(const SupportCore& a, const SupportCore& b) {
  return grown(core_distance(a, b), a, b);
}

}  // namespace tw
