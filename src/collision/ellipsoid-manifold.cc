// Contact manifolds of ellipsoids: one point each.
//
// Where it touches an ellipsoid is followed as the ball that osculates it in the mean, so that what
// it meets is what the ball meets; on a plane the ellipsoid is followed itself (tangent_plane).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/ellipsoid-point.h"
#include "collision/manifold-parts.h"
#include "collision/separation.h"

namespace tw {

namespace {

// The mean radius of curvature where the normal (unit, the ellipsoid's frame) is: half the trace of
// A^2/h - A^2 n (A^2 n)^T/h^3, which is square to n.
double mean_radius(const Vec3& semi_axes, const Vec3& n) {
  const Vec3 squares = semi_axes.cwiseAbs2(), point = squares.cwiseProduct(n);
  const double h = std::sqrt(n.dot(point));
  return 0.5 * (squares.sum() / h - point.squaredNorm() / (h * h * h));
}

// The ball inside the part at its surface point (world) with this outward normal; another part is
// what it is.
ConvexPart ball_at(const ConvexPart& part, const Frame& frame, const Vec3& point,
                   const Vec3& outward) {
  if (part.kind != PartKind::ellipsoid) return part;
  const Frame world = frame * part.placement;
  ConvexPart ball;
  ball.radius = mean_radius(part.semi_axes, world.R.transpose() * outward);
  ball.placement.p = frame.to_local(point - ball.radius * outward);
  ball.bound_center = ball.placement.p;
  ball.bound_radius = ball.radius;
  return ball;
}

}  // namespace

void ellipsoid_manifold_at(const ConvexPart& a, const Frame& frame_a, const ConvexPart& b,
                           const Frame& frame_b, const RoundDistance& near, double reach, int pair,
                           std::vector<ManifoldPoint>& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  part_manifold(ball_at(a, frame_a, near.point_a, near.normal), frame_a,
                ball_at(b, frame_b, near.point_b, -near.normal), frame_b, reach,
                ReferenceChoice::larger, pair, out);
  for (auto p = out.begin() + first; p != out.end(); ++p)
    if (p->kind == ReferenceFeature::plane) p->kind = ReferenceFeature::tangent_plane;
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
