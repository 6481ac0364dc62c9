// The axis of greatest separation near a given one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/smooth-axis.h"

#include <algorithm>
#include <cmath>

#include "collision/distance/frustum-point.h"

namespace tw {

namespace {

constexpr int newton_steps = 12, secant_steps = 12;

// what s may lose where its slope falls, relative to the size
constexpr double value_rounding = 1e-15;

// a line this near to square to the axis may lie along its plane, sine
constexpr double nearly_square = 0.1;

struct Reach {
  Vec3 w;    // from the farthest point of A to that of B
  double s;  // along n
};

Reach reach_along(const SupportCore& a, const SupportCore& b, const Vec3& n) {
  const Vec3 w = b.support(-n) - a.support(n);
  return {w, n.dot(w)};
}

// Second derivatives of the support function along the unit vector n.
Mat3 support_curvature(const SupportCore& core, const Vec3& n) {
  if (core.kind == PartKind::ellipsoid) {
    const Vec3 d = core.place.R.transpose() * n;
    const Vec3 squares = core.semi_axes.cwiseAbs2(), point = squares.cwiseProduct(d);
    const double h = std::sqrt(d.dot(point));
    const Mat3 local = Mat3(squares.asDiagonal()) / h - point * point.transpose() / (h * h * h);
    return core.place.R * local * core.place.R.transpose();
  }
  if (core.kind == PartKind::frustum) {
    const Vec3 tangent = core.axis().cross(n), d = core.place.R.transpose() * n;
    const double across = tangent.norm();
    const bool down = 2 * core.half_length * d.z() < (core.radius - core.top_radius) * across;
    if (!(across > 0)) return Mat3::Zero();
    return (down ? core.radius : core.top_radius) / (across * across * across) * tangent *
           tangent.transpose();
  }
  return Mat3::Zero();
}

void newton(const SupportCore& a, const SupportCore& b, Vec3& n, Reach& best) {
  const double size = a.size() + b.size();
  for (int step = 0; step < newton_steps; ++step) {
    const Mat3 bend = support_curvature(a, n) + support_curvature(b, -n);
    Eigen::Matrix<double, 3, 2> T;
    T.col(0) = n.unitOrthogonal();
    T.col(1) = n.cross(T.col(0));
    Eigen::Matrix2d curvature = T.transpose() * bend * T;
    curvature.diagonal().array() += best.s;
    const double det = curvature.determinant();
    if (!(det > 0) || !(curvature.trace() > 0)) return;
    const Eigen::Vector2d g = T.transpose() * best.w;
    const Eigen::Vector2d y((curvature(1, 1) * g.x() - curvature(0, 1) * g.y()) / det,
                            (curvature(0, 0) * g.y() - curvature(0, 1) * g.x()) / det);
    const Vec3 next = (n + T * y).normalized();
    const Reach there = reach_along(a, b, next);
    // s is flat at its top: there the gradient shows the way
    const double slope = there.w.cross(next).norm();
    const bool nearer =
        there.s > best.s - value_rounding * size && slope < 0.5 * best.w.cross(n).norm();
    if (!(there.s > best.s) && !nearer) return;
    n = next;
    best = there;
  }
}

Vec3 turned(const Vec3& n, const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis) * n;
}

// Turns n about the axis to where s, smooth on the way, is greatest; takes it if that is more.
void turn_about(const SupportCore& a, const SupportCore& b, const Vec3& axis, Vec3 from, Vec3& n,
                Reach& best) {
  from.normalize();
  const auto slope = [&](const Vec3& at, const Vec3& w) { return axis.cross(at).dot(w); };
  Reach here = reach_along(a, b, from);
  const double size = a.size() + b.size();
  double x0 = 0, f0 = slope(from, here.w), least = std::abs(f0),
         x1 = std::clamp(f0 / size, -0.01, 0.01);
  if (x1 == 0) x1 = 1e-6;
  Vec3 most = from;
  Reach reached = here;
  for (int step = 0; step < secant_steps; ++step) {
    const Vec3 at = turned(from, axis, x1);
    here = reach_along(a, b, at);
    const double f1 = slope(at, here.w);
    const bool level = here.s > reached.s - value_rounding * size && std::abs(f1) < least;
    if (here.s > reached.s || level) {
      reached = here;
      most = at;
      least = std::abs(f1);
    }
    if (f1 == f0 || f1 == 0) break;
    const double next = std::clamp(x1 - f1 * (x1 - x0) / (f1 - f0), -1.0, 1.0);
    if (next == x1) break;
    x0 = x1;
    f0 = f1;
    x1 = next;
  }
  if (!(reached.s > best.s - value_rounding * size)) return;
  n = most.normalized();
  best = reach_along(a, b, n);
}

// Lines of a core that the axis may be square to: the edges at its farthest vertex, or a generatrix
// of a frustum, which turns with the axis about that of the frustum.
void along_lines(const SupportCore& a, const SupportCore& b, bool of_a, Vec3& n, Reach& best) {
  const SupportCore& core = of_a ? a : b;
  const Vec3 outward = of_a ? n : Vec3(-n);
  const Vec3 d = core.place.R.transpose() * outward;
  if (core.polyhedron != nullptr) {
    const int vertex = core.polyhedron->support(d, 0);
    const Vec3 start = n;
    for (const Polyhedron::Link& link : core.polyhedron->links(vertex)) {
      const Vec3 edge =
          core.place.R *
          (core.polyhedron->vertex(link.vertex) - core.polyhedron->vertex(vertex)).normalized();
      const double along = edge.dot(start);
      if (std::abs(along) < nearly_square) turn_about(a, b, edge, start - along * edge, n, best);
    }
    return;
  }
  if (core.kind != PartKind::frustum) return;
  const SideNormal side(core);
  const double across = std::hypot(d.x(), d.y());
  if (!(across > 0) || std::abs(d.z() - side.along) > nearly_square) return;
  const Vec3 flat =
      core.place.R * Vec3(side.across * d.x() / across, side.across * d.y() / across, side.along);
  turn_about(a, b, core.axis(), of_a ? flat : Vec3(-flat), n, best);
}

}  // namespace

SmoothAxis climb_smooth(const SupportCore& a, const SupportCore& b, const Vec3& start) {
  constexpr int most_rounds = 8;
  constexpr double found = 1e-14;
  const double size = a.size() + b.size();
  Vec3 n = start;
  Reach best = reach_along(a, b, n);
  // where farthest points change on the way, on from there
  for (int round = 0; round < most_rounds; ++round) {
    const double before = best.s;
    newton(a, b, n, best);
    // bodies apart are no farther apart than these two points
    if (best.s > 0 && best.w.norm() - best.s <= found * size) break;
    along_lines(a, b, true, n, best);
    along_lines(a, b, false, n, best);
    if (!(best.s > before + found * size)) break;
  }
  return {n, best.s};
}

}  // namespace tw
