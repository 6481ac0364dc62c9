// Certificates: until when two bodies are surely apart.
//
// For each pair of convex parts a plane is put midway between them, across the witness direction n,
// and moves with the mean of the witness points' velocity and the bodies' acceleration along n.  As
// long as every point of a part's core stays on its side, the parts are apart.  A core point r of a
// body in free flight has the height along n
//   h(s) <= h0 + n.(v + w x r) s + (n.a + (1 + kappa) W^2 |r|) s^2 / 2
// with W a bound on |w| over the arc and kappa = max |Ii - Ij|/Ik, since |w'| <= kappa W^2 for
// torque-free rotation.  So the time until the plane may be reached is the least root of quadratics:
// close to the true impact time, and never after it.  Kinematic bodies are bounded by their speed,
// over a horizon.
//
// With an allowance the plane gives way by half of it to either side: bodies that slide past each other
// at touch are then apart for as long as they do.
//
// The certificate decides only where the next query is made, never the answer: warm simplices are
// allowed here.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "geometry/polyhedron.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

// How far ahead the speed of a kinematic body is bounded, s.
constexpr double kinematic_horizon = 0.5;

// Bounding balls this many radii apart need no distance query.
constexpr double far_in_radii = 0.25;

// One body of the pair at the certificate's time.
struct Side {
  const Body* body;
  Frame frame;
  ArcPoint point;
  double turn_bound = 0;       // W, rad/s
  double speed_bound = 0;      // kinematic: the origin's
  Vec3 acceleration = Vec3::Zero();

  Side(const Body& b, const State& arc, double when) : body(&b), point(evaluate(b, arc, when)) {
    frame = Frame(point.q.toRotationMatrix(), point.x);
    if (b.fixed()) return;
    turn_bound = angular_speed_bound(b, arc, when, when + kinematic_horizon);
    if (b.dynamic())
      acceleration = arc.acceleration;
    else
      speed_bound = b.motion->speed_bound(when, when + kinematic_horizon);
  }
  Vec3 velocity_at(const Vec3& world_point) const {
    return point.v + point.w.cross(world_point - point.x);
  }
};

// Least s > 0 with gap + speed s + pull s^2/2 = 0; gap > 0.  Each branch without cancellation: just
// after an impact the gap is rounding and the speed is not.
double first_zero(double gap, double speed, double pull) {
  const double disc = speed * speed - 2 * pull * gap;
  if (disc < 0) return never;
  const double root = std::sqrt(disc);
  if (speed > 0) return pull < 0 ? (speed + root) / -pull : never;
  return root - speed > 0 ? 2 * gap / (root - speed) : never;
}

// The plane: at height c along n, moving with u and alpha.
struct Plane {
  Vec3 n;
  double c = 0, u = 0, alpha = 0;
  double allowance = 0;  // points may stand this far on the wrong side
};

// When a core point (offset r from the centre, world) with a radius may reach the plane, n towards it.
double reach(const Side& side, const Vec3& n, double c, double u, double alpha, const Vec3& r,
             double radius) {
  const double gap = c - n.dot(side.point.x + r) - radius;
  if (!(gap > 0)) return 0;
  const double arm = r.norm();
  if (!side.body->dynamic()) {
    const double bound = side.speed_bound + side.turn_bound * arm;
    return first_zero(gap, u - bound, alpha);
  }
  const double speed = n.dot(side.point.v + side.point.w.cross(r));
  const double bend = (1 + side.body->turn_excess) * side.turn_bound * side.turn_bound * arm;
  return first_zero(gap, u - speed, alpha - n.dot(side.acceleration) - bend);
}

// The least over the core points of a part; `sign` +1: the part lies below the plane, -1 above.
double part_reach(const Side& side, const ConvexPart& part, const Plane& plane, double sign,
                  bool as_ball) {
  const Vec3 n = sign * plane.n;
  const double c = sign * plane.c + plane.allowance;
  const double u = sign * plane.u, alpha = sign * plane.alpha;
  if (part.kind == PartKind::half_space) {
    // stands, or moves without turning
    const double gap = c - n.dot(side.frame * (part.normal * part.offset));
    return gap > 0 ? first_zero(gap, u - side.speed_bound, alpha) : 0;
  }
  if (as_ball || part.kind == PartKind::sphere)
    return reach(side, n, c, u, alpha, side.frame.R * part.bound_center, part.bound_radius);
  double least = never;
  for (const Vec3& vertex : part.core->vertices())
    least = std::min(least, reach(side, n, c, u, alpha,
                                  side.frame.R * (part.placement * vertex), 0));
  return least;
}

// Seconds until the two parts may meet, given n from a to b and the witness points.
double time_apart(const Side& a, const ConvexPart& part_a, const Side& b, const ConvexPart& part_b,
                  const Vec3& n, const Vec3& point_a, const Vec3& point_b, double allowance,
                  bool as_balls) {
  Plane plane;
  plane.allowance = 0.5 * allowance;
  plane.n = n;
  plane.c = 0.5 * n.dot(point_a + point_b);
  plane.u = 0.5 * n.dot(a.velocity_at(point_a) + b.velocity_at(point_b));
  plane.alpha = 0.5 * n.dot(a.acceleration + b.acceleration);
  const double below = part_reach(a, part_a, plane, 1, as_balls);
  if (!(below > 0)) return 0;
  return std::min(below, part_reach(b, part_b, plane, -1, as_balls));
}

}  // namespace

double Kernel::certificate(Pair& pair, const Piece& piece, double when, double allowance) {
  const Side a(*bodies[pair.a], *piece.a, when), b(*bodies[pair.b], *piece.b, when);
  const auto& parts_a = a.body->shape_P->parts();
  const auto& parts_b = b.body->shape_P->parts();
  double least = never;
  if (a.body->info.kind == BodyKind::kinematic || b.body->info.kind == BodyKind::kinematic)
    least = kinematic_horizon;

  for (std::size_t i = 0; i < parts_a.size(); ++i)
    for (std::size_t j = 0; j < parts_b.size(); ++j) {
      const ConvexPart& pa = parts_a[i];
      const ConvexPart& pb = parts_b[j];
      const bool balls = std::isfinite(pa.bound_radius) && std::isfinite(pb.bound_radius);

      // far apart: the bounding balls will do
      if (balls) {
        const Vec3 ca = a.frame * pa.bound_center, cb = b.frame * pb.bound_center;
        const double centers = (cb - ca).norm(), radii = pa.bound_radius + pb.bound_radius;
        const bool spheres = pa.kind == PartKind::sphere && pb.kind == PartKind::sphere;
        if (spheres && !(centers > radii - allowance && centers > 0)) return -never;
        if (spheres || centers - radii > far_in_radii * radii) {
          const Vec3 n = (cb - ca) / centers;
          least = std::min(least, time_apart(a, pa, b, pb, n, ca + pa.bound_radius * n,
                                             cb - pb.bound_radius * n, allowance, true));
          continue;
        }
      }

      if (pair.caches.empty()) pair.caches.resize(parts_a.size() * parts_b.size());
      SimplexCache& cache = pair.caches[i * parts_b.size() + j];
      const Separation s = part_separation(pa, a.frame, pb, b.frame, &cache);
      if (!(s.distance > -allowance)) return -never;
      least = std::min(least, time_apart(a, pa, b, pb, s.normal, s.point_a, s.point_b, allowance,
                                         false));
    }
  ++counters.certificates;
  return when + least;
}

}  // namespace tw
