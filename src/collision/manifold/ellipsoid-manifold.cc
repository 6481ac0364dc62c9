// Contact manifolds of ellipsoids: one point each.
//
// What it meets is what the ball meets that osculates it in the mean, and it is followed there
// itself: on a plane as `tangent_plane`, elsewhere as `curved`.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "collision/distance/ellipsoid-point.h"
#include "collision/distance/separation.h"
#include "collision/manifold/manifold-parts.h"

namespace tw {

namespace {

// Radii of curvature: the mean one and the least.
struct Radii {
  double mean = 0, least = 0;
};

// Where the normal (unit, the ellipsoid's frame) is: the eigenvalues of A^2/h - A^2 n (A^2
// n)^T/h^3, which is square to n; their product is (det A/h^2)^2.
Radii radii_at(const Vec3& semi_axes, const Vec3& n) {
  const Vec3 squares = semi_axes.cwiseAbs2(), point = squares.cwiseProduct(n);
  const double h = std::sqrt(n.dot(point));
  const double mean = 0.5 * (squares.sum() / h - point.squaredNorm() / (h * h * h));
  const double root = semi_axes.prod() / (h * h);
  const double difference = std::sqrt(std::max(mean * mean - root * root, 0.0));
  return {mean, root * root / (mean + difference)};
}

// The ball inside the part at its surface point (world) with this outward normal; another part is
// what it is.
struct Osculating {
  Osculating(const ConvexPart& of, const Frame& frame, const Vec3& point, const Vec3& outward)
      : is_ellipsoid(of.kind == PartKind::ellipsoid), part(of) {
    if (!is_ellipsoid) return;
    const Frame world = of.in(frame);
    radii = radii_at(of.semi_axes, world.R.transpose() * outward);
    ball.radius = radii.mean;
    ball.bound_center = frame.to_local(point - ball.radius * outward);
    ball.place({Mat3::Identity(), ball.bound_center});
    ball.bound_radius = ball.radius;
  }
  const ConvexPart& shown() const { return is_ellipsoid ? ball : part; }
  double least(double otherwise) const { return is_ellipsoid ? radii.least : otherwise; }

  bool is_ellipsoid;
  const ConvexPart& part;
  ConvexPart ball;
  Radii radii;
};

// Of a sharp tip that is deeper than its radius no axis has the greatest gap: it stays a ball.
void follow(ManifoldPoint& p, const Osculating& reference, const Osculating& other) {
  if (p.kind == ContactFeature::plane) {
    if (other.is_ellipsoid) p.kind = ContactFeature::tangent_plane;
    return;
  }
  const double sharpest = reference.least(p.reference_radius) + other.least(p.radius);
  if (p.gap < -0.5 * sharpest) return;
  if (p.kind == ContactFeature::point) p.direction.setZero();
  p.kind = ContactFeature::curved;
}

}  // namespace

void ellipsoid_manifold_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                           const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                           std::vector<ManifoldPoint>& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  const Osculating of_a(a, frame_a, near.point_a, near.normal);
  const Osculating of_b(b, frame_b, near.point_b, -near.normal);
  part_manifold(of_a.shown(), frame_a, of_b.shown(), frame_b, reach, ReferenceChoice::larger, pair,
                out);
  for (auto p = out.begin() + first; p != out.end(); ++p)
    p->reference_is_a ? follow(*p, of_a, of_b) : follow(*p, of_b, of_a);
}

void ellipsoid_manifold(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                        const Frame& frame_b, double reach, int pair,
                        std::vector<ManifoldPoint>& out) {
  const Separation s = part_separation(a, frame_a, b, frame_b, nullptr);
  if (s.distance > reach) return;
  ellipsoid_manifold_at(a, frame_a, b, frame_b, {s.distance, s.normal, s.point_a, s.point_b}, reach,
                        pair, out);
}

}  // namespace tw
