// Certificates: until when two bodies are surely apart.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "detect/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "collision/broad/near-parts.h"
#include "collision/distance/support-core.h"
#include "detect/round-reach.h"
#include "detect/turning-plane.h"
#include "geometry/polyhedron.h"

namespace tw {
namespace {

// The plane: at height c along n, moving with u and alpha.
struct Plane {
  Vec3 n;
  double c = 0, u = 0, alpha = 0;
  double allowance = 0;  // points may stand this far on the wrong side
};

// When a core point (offset r from the centre, world) with a radius may reach the plane, n towards
// it.
double reach(const MovingBody& side, const Vec3& n, double c, double u, double alpha, const Vec3& r,
             double radius) {
  const double gap = c - n.dot(side.point.x + r) - radius;
  if (!(gap > 0)) return 0;
  const double arm = r.norm();
  if (side.by_speed) {
    const double bound = side.bounds.speed + side.bounds.turn * arm;
    return first_zero(gap, u - bound, alpha);
  }
  const double speed = n.dot(side.point.v + side.point.w.cross(r));
  const double push = n.dot(side.acceleration) + n.cwiseAbs().dot(side.spread) + side.bend * arm;
  return first_zero(gap, u - speed, alpha - push);
}

// The least over the points of a part of a kinematic body: by its bounds.
double kinematic_reach(const MovingBody& side, const ConvexPart& part, const Vec3& n, double c,
                       double u, double alpha) {
  if (part.kind != PartKind::polyhedron)
    return reach(side, n, c, u, alpha, side.frame.R * part.bound_center, part.bound_radius);
  double least = never;
  for (const Vec3& vertex : part.core->vertices())
    least =
        std::min(least, reach(side, n, c, u, alpha, side.frame.R * (part.placement() * vertex), 0));
  return least;
}

// The least over the core points of a part; `sign` +1: the part lies below the plane, -1 above.
double part_reach(const MovingBody& side, const ConvexPart& part, const Plane& plane, double sign,
                  bool as_ball) {
  const Vec3 n = sign * plane.n;
  const double c = sign * plane.c + plane.allowance;
  const double u = sign * plane.u, alpha = sign * plane.alpha;
  if (part.kind == PartKind::half_space) {
    // stands, or moves without turning
    const double gap = c - n.dot(side.frame * (part.normal * part.offset));
    return gap > 0 ? first_zero(gap, u - side.bounds.speed, alpha) : 0;
  }
  if (as_ball || part.kind == PartKind::sphere)
    return reach(side, n, c, u, alpha, side.frame.R * part.bound_center, part.bound_radius);
  if (side.by_speed) return kinematic_reach(side, part, n, c, u, alpha);

  // heights and speeds of points are linear in them: in the part's frame,
  // n.(x + r) = n.x + n_P.p + .., n.(v + w x r) = n.v + m_P.p + .. with m = n x w
  const Frame frame = part.in(Frame(side.frame.R, Vec3::Zero()));
  const Vec3 m = n.cross(side.point.w);
  const Vec3 n_P = frame.R.transpose() * n, m_P = frame.R.transpose() * m;
  const double height = n.dot(side.point.x + frame.p), speed = n.dot(side.point.v) + m.dot(frame.p);
  const double pull_of_center = alpha - n.dot(side.acceleration) - n.cwiseAbs().dot(side.spread);
  const auto least = [&](double bend) {
    const double pull = pull_of_center - bend * side.body->radius;
    if (part.kind != PartKind::polyhedron) {
      const double gap = c - height - round_top(part, n_P) - part.margin;
      return gap > 0 ? round_reach(part, gap, u - speed, pull, n_P, m_P) : 0;
    }
    double first = never;
    for (const Vec3& vertex : part.core->vertices()) {
      const double gap = c - height - n_P.dot(vertex);
      if (!(gap > 0)) return 0.0;
      const double rate = u - speed - m_P.dot(vertex);
      // a concave height that is positive at both ends is so between
      if (pull <= 0 && gap + first * (rate + 0.5 * pull * first) > 0) continue;
      first = std::min(first, first_zero(gap, rate, pull));
    }
    return first;
  };
  return side.longest_along(n, least);
}

// A point of a part farthest along the unit n; `point` is one, for what is not known better.
Vec3 top_along(const MovingBody& side, const ConvexPart& part, const Vec3& n, const Vec3& point) {
  if (part.kind == PartKind::half_space || part.kind == PartKind::sphere) return point;
  const SupportCore core(part, part.in(side.frame));
  return core.support(n) + core.margin * n;
}

// A second look at the plane between two parts: at the middle of what reaches highest of either,
// and square to a normal made truer.  Of nearest points some roundings apart the direction is
// hardly known, and what lies along an edge or over a face would reach through with its far end.
// Square to what leads from the nearest points to the farthest ones the normal is exact: to one
// such direction along an edge, to two over a face.
Plane truer_plane(const MovingBody& a, const ConvexPart& part_a, const MovingBody& b,
                  const ConvexPart& part_b, const Separation& s) {
  Plane plane;
  Vec3 n = s.normal, along = Vec3::Zero();
  double widest = -never;
  for (int look = 0; look < 3; ++look) {
    const Vec3 top_a = top_along(a, part_a, n, s.point_a);
    const Vec3 top_b = top_along(b, part_b, -n, s.point_b);
    const double gap = n.dot(top_b - top_a);
    if (gap > widest) {
      widest = gap;
      plane.n = n;
      plane.c = 0.5 * n.dot(top_a + top_b);
    }
    if (s.distance <= 0 || 2 * gap >= s.distance) break;  // exact, or as wide as may be
    const Vec3 to_farthest = (top_b - top_a) - (s.point_b - s.point_a);
    Vec3 square = look == 0 ? Vec3(n - n.dot(to_farthest) / to_farthest.squaredNorm() * to_farthest)
                            : along.cross(to_farthest);
    along = to_farthest;
    const double length = square.norm();
    if (!(length > 0)) break;
    n = std::copysign(1 / length, square.dot(s.normal)) * square;
  }
  return plane;
}

// Seconds until the two parts may meet, given n from a to b and the witness points; the plane
// between them is at the height c.
double time_apart(const MovingBody& a, const ConvexPart& part_a, const MovingBody& b,
                  const ConvexPart& part_b, const Vec3& n, double c, const Vec3& point_a,
                  const Vec3& point_b, double allowance, bool a_as_ball, bool b_as_ball) {
  Plane plane;
  plane.allowance = 0.5 * allowance;
  plane.n = n;
  plane.c = c;
  plane.u = 0.5 * n.dot(a.velocity_at(point_a) + b.velocity_at(point_b));
  plane.alpha = 0.5 * n.dot(a.acceleration + b.acceleration);
  const double below = part_reach(a, part_a, plane, 1, a_as_ball);
  if (!(below > 0)) return 0;
  return std::min(below, part_reach(b, part_b, plane, -1, b_as_ball));
}

// The same of all that is in a box of one body (its frame) and of a part of another one by its
// ball, given n from the box to the ball.
double box_time_apart(const MovingBody& side, const Aabb& box, const MovingBody& other,
                      const ConvexPart& part, const Vec3& n, const Vec3& on_box,
                      const Vec3& on_ball, double allowance) {
  const double c = 0.5 * n.dot(on_box + on_ball);
  const double u = 0.5 * n.dot(side.velocity_at(on_box) + other.velocity_at(on_ball));
  const double alpha = 0.5 * n.dot(side.acceleration + other.acceleration);
  const double more = 0.5 * allowance;
  const double above =
      reach(other, -n, more - c, -u, -alpha, other.frame.R * part.bound_center, part.bound_radius);
  if (!(above > 0)) return 0;
  // a corner is the first point of a box to reach a plane; of one that does not turn always the
  // same
  const Vec3 along = side.frame.R.transpose() * n;
  if (!(side.bounds.turn > 0) && side.point.w.isZero()) {
    const Vec3 top = (along.array() > 0).select(box.hi, box.lo);
    return std::min(above, reach(side, n, c + more, u, alpha, side.frame.R * top, 0));
  }
  double below = never;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = side.frame.R * box.corner(corner);
    below = std::min(below, reach(side, n, c + more, u, alpha, x, 0));
  }
  return std::min(below, above);
}

// Seconds until two bodies may come nearer by `slack`, m > 0, by what their points may move against
// each other at most.  For those that touch and hardly move: along a line or over a face no plane
// is so exact that rounding leaves all of both on its sides.
double still_apart(const MovingBody& a, const MovingBody& b, double slack) {
  const auto turning = [](const MovingBody& side) {
    return side.bounds.turn > 0 ? side.bounds.turn * side.body->radius : 0;
  };
  const auto center_speed = [](const MovingBody& side) {
    return side.by_speed ? side.bounds.speed : side.point.v.norm();
  };
  const double centers =
      a.by_speed || b.by_speed ? center_speed(a) + center_speed(b) : (a.point.v - b.point.v).norm();
  const double change = (a.acceleration - b.acceleration).norm() + (a.spread + b.spread).norm();
  return first_zero(slack, -(centers + turning(a) + turning(b)), -change);
}

}  // namespace

double distance_rounding(const Body& a, const Vec3& at_a, const Body& b, const Vec3& at_b) {
  constexpr double of_width = 1e-14;
  constexpr double of_coordinates = 4 * std::numeric_limits<double>::epsilon();
  const auto coordinates = [](const Body& body, const Vec3& x) {
    return x.norm() + (body.unbounded ? 0 : body.radius);
  };
  return of_width * std::min(a.least_width, b.least_width) +
         of_coordinates * (coordinates(a, at_a) + coordinates(b, at_b));
}

Certificates::Certificates(const Piece& piece, SimplexCaches& caches, double when,
                           const SeenApart* seen)
    : piece_(piece),
      caches_(caches),
      when_(when),
      a_(*piece.body_a, piece.a->trajectory(), when),
      b_(*piece.body_b, piece.b->trajectory(), when),
      rounding_(distance_rounding(*a_.body, a_.point.x, *b_.body, b_.point.x)) {
  if (seen && seen->when == when) kept_[0] = seen->separation;
}

const Separation& Certificates::separation(std::size_t i, std::size_t j) {
  const Shape& a = *a_.body->shape_P;
  const Shape& b = *b_.body->shape_P;
  const std::size_t place = i * b.part_count() + j;
  std::optional<Separation>& found = place < most_kept ? kept_[place] : last_;
  if (found && place < most_kept) return *found;
  SimplexCache& cache = caches_.of(place, a.part_count() * b.part_count());
  found = part_separation(a.part(i), a_.frame, b.part(j), b_.frame, &cache);
  return *found;
}

std::optional<double> Certificates::overlap() const {
  const auto is_polyhedron = [](const MovingBody& side) {
    const Shape& shape = *side.body->shape_P;
    return shape.part_count() == 1 && shape.part(0).kind == PartKind::polyhedron;
  };
  // of polyhedra that overlap the query is cold, whatever its warm start
  if (!kept_[0] || !(kept_[0]->distance < 0) || !is_polyhedron(a_) || !is_polyhedron(b_)) return {};
  return kept_[0]->distance;
}

// A step of an arc has narrow bounds, all of them wide ones: by both, the narrow ones where needed.
template <class Bound>
double Certificates::by_step(const Bound& bound) {
  if (!in_steps()) return bound(a_, b_);
  if (!step_a_) {
    step_a_.emplace(a_.within_step());
    step_b_.emplace(b_.within_step());
  }
  return std::min(std::min(step_a_->bounds.valid_until, step_b_->bounds.valid_until) - when_,
                  bound(*step_a_, *step_b_));
}

template <class Bound>
double Certificates::longest(const Bound& bound) {
  const double left = bound(a_, b_);
  return in_steps() && left < piece_.end.time - when_ ? std::max(left, by_step(bound)) : left;
}

double Certificates::parts_apart(std::size_t i, std::size_t j, double allowance) {
  const MovingBody &a = a_, &b = b_;
  const ConvexPart& pa = a.body->shape_P->part(i);
  const ConvexPart& pb = b.body->shape_P->part(j);
  const double sure = rounding_ - allowance;

  // far apart: the bounding balls will do
  if (std::isfinite(pa.bound_radius) && std::isfinite(pb.bound_radius)) {
    const Vec3 ca = a.frame * pa.bound_center, cb = b.frame * pb.bound_center;
    const double centers = (cb - ca).norm(), radii = pa.bound_radius + pb.bound_radius;
    const bool spheres = pa.kind == PartKind::sphere && pb.kind == PartKind::sphere;
    if (spheres && !(centers - radii > sure && centers > 0)) return -never;
    if (spheres || centers - radii > cost::far_in_radii * radii) {
      const Vec3 n = (cb - ca) / centers;
      const Vec3 on_a = ca + pa.bound_radius * n, on_b = cb - pb.bound_radius * n;
      const double c = 0.5 * n.dot(on_a + on_b);
      return longest([&](const MovingBody& x, const MovingBody& y) {
        return time_apart(x, pa, y, pb, n, c, on_a, on_b, allowance, true, true);
      });
    }
  }

  Separation s = separation(i, j);
  if (!(s.distance > sure)) return -never;
  const auto by_plane = [&](double c) {
    return longest([&](const MovingBody& x, const MovingBody& y) {
      return time_apart(x, pa, y, pb, s.normal, c, s.point_a, s.point_b, allowance, false, false);
    });
  };
  double apart = by_plane(0.5 * s.normal.dot(s.point_a + s.point_b));
  if (!(apart > 0)) {
    const Plane truer = truer_plane(a, pa, b, pb, s);
    s.normal = truer.n;
    apart = by_plane(truer.c);
  }
  // where edges and faces turn past each other, a plane that turns with them lasts longer
  if (apart < cost::soon && can_turn(a, pa) && can_turn(b, pb))
    apart = std::max(apart, by_step([&](const MovingBody& x, const MovingBody& y) {
                       return turning_time_apart(x, pa, y, pb, s, allowance);
                     }));
  if (apart < cost::soon)
    apart = std::max(apart, by_step([&](const MovingBody& x, const MovingBody& y) {
                       return still_apart(x, y, s.distance + allowance);
                     }));
  return apart;
}

// A part by its ball against all parts in a node of the other body's tree by their box.  What these
// bounds leave out is surely apart, whatever the warm queries said of the parts before it: else the
// answer would depend on the caches.
double Certificates::boxes_apart(const ConvexPart& part, const PartTree::Node& node, bool of_b,
                                 double allowance) {
  const MovingBody& tree = of_b ? b_ : a_;
  const MovingBody& other = of_b ? a_ : b_;
  const Vec3 center = other.frame * part.bound_center;
  const Vec3 seen = tree.frame.to_local(center);
  const Vec3 nearest = seen.cwiseMax(node.box.lo).cwiseMin(node.box.hi);
  const double distance = (seen - nearest).norm();
  if (!(distance - part.bound_radius > rounding_)) return 0;
  const Vec3 out = tree.frame.R * ((seen - nearest) / distance);
  const Vec3 on_box = tree.frame * nearest, on_ball = center - part.bound_radius * out;
  return longest([&](const MovingBody& x, const MovingBody& y) {
    return box_time_apart(of_b ? y : x, node.box, of_b ? x : y, part, out, on_box, on_ball,
                          allowance);
  });
}

// A part against the face of a polyhedron of the other body that it is most over.
double Certificates::planes_apart(const ConvexPart& part, const ConvexPart& other, bool of_b,
                                  double allowance) {
  const MovingBody& side = of_b ? b_ : a_;
  const MovingBody& over = of_b ? a_ : b_;
  const FaceGap over_face = gap_over_face(part, over.frame, other, side.frame);
  if (!(over_face.gap > rounding_)) return 0;
  const Vec3 n = over_face.normal, on_face = over_face.foot;
  const Vec3 on_part = on_face + over_face.gap * n;
  const double c = 0.5 * n.dot(on_face + on_part);
  const bool as_ball = part.kind != PartKind::polyhedron;
  if (of_b)
    return longest([&](const MovingBody& x, const MovingBody& y) {
      return time_apart(x, part, y, other, -n, -c, on_part, on_face, allowance, as_ball, false);
    });
  return longest([&](const MovingBody& x, const MovingBody& y) {
    return time_apart(x, other, y, part, n, c, on_face, on_part, allowance, false, as_ball);
  });
}

void Certificates::search(std::size_t few, const PartTree::Node& node, bool of_b, double allowance,
                          double& least) {
  const Shape& shape = *(of_b ? b_ : a_).body->shape_P;
  const ConvexPart& part = (of_b ? a_ : b_).body->shape_P->part(few);
  if (node.is_leaf) {
    const std::size_t number = node.first;
    if (planes_apart(part, shape.part(number), of_b, allowance) >= least) return;
    least = std::min(
        least, of_b ? parts_apart(few, number, allowance) : parts_apart(number, few, allowance));
    return;
  }
  const PartTree& tree = *shape.tree();
  const PartTree::Node *first = &tree.node(node.first), *second = &tree.node(node.first + 1);
  double one = boxes_apart(part, *first, of_b, allowance);
  double two = boxes_apart(part, *second, of_b, allowance);
  if (two < one) {
    std::swap(first, second);
    std::swap(one, two);
  }
  // what lasts longer than the least so far says nothing
  if (one < least) search(few, *first, of_b, allowance, least);
  if (two < least) search(few, *second, of_b, allowance, least);
}

double Certificates::until(double allowance) {
  const Shape& a = *a_.body->shape_P;
  const Shape& b = *b_.body->shape_P;
  const double valid = std::min(a_.bounds.valid_until, b_.bounds.valid_until);
  double least = valid - when_;
  if (a.tree() || b.tree()) {
    // what comes after the end of the piece says nothing either
    const double last = piece_.end.time > when_ ? std::min(valid, piece_.end.time) : valid;
    least = last - when_;
    const bool in_b = searches_second(a, b);
    const std::size_t few = (in_b ? a : b).part_count();
    for (std::size_t i = 0; i < few && least > -never; ++i)
      search(i, (in_b ? b : a).tree()->root(), in_b, allowance, least);
    return least == -never ? -never : least < last - when_ ? when_ + least : last;
  }
  for (std::size_t i = 0; i < a.part_count(); ++i)
    for (std::size_t j = 0; j < b.part_count(); ++j) {
      const double apart = parts_apart(i, j, allowance);
      if (apart == -never) return -never;
      least = std::min(least, apart);
    }
  return when_ + least;
}

double certificate(const Piece& piece, SimplexCaches& caches, double when, double allowance,
                   const SeenApart* seen) {
  return Certificates(piece, caches, when, seen).until(allowance);
}

}  // namespace tw
