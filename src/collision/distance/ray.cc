// Where a ray meets a shape: the stretch of it inside each convex part.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/ray.h"

#include <cmath>
#include <limits>
#include <utility>

#include "collision/distance/frustum-point.h"
#include "geometry/part-tree.h"
#include "geometry/polyhedron.h"

namespace tw {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Ray {
  Vec3 from, direction;
  Vec3 at(double s) const { return from + s * direction; }
};

// The stretch of the line that is inside, and the outward normal where it enters; empty: from > to.
struct Inside {
  double from = -infinity, to = infinity;
  Vec3 normal = Vec3::Zero();

  void enter(double s, const Vec3& outward) {
    if (!(s > from)) return;
    from = s;
    normal = outward;
  }
  void leave(double s) {
    if (s < to) to = s;
  }
  void miss() {
    from = infinity;
    to = -infinity;
  }
};

// Inside where normal.x <= offset.
void clip_by_plane(const Ray& ray, const Vec3& normal, double offset, Inside& inside) {
  const double height = normal.dot(ray.from) - offset, rate = normal.dot(ray.direction);
  if (rate < 0)
    inside.enter(-height / rate, normal);
  else if (rate > 0)
    inside.leave(-height / rate);
  else if (height > 0)
    inside.miss();
}

// Roots of a s^2 + 2 b s + c, a != 0, ascending, without cancellation; false: none.
bool roots(double a, double b, double c, double& low, double& high) {
  const double disc = b * b - a * c;
  if (disc < 0) return false;
  const double q = -(b + std::copysign(std::sqrt(disc), b));
  low = q / a;
  high = q != 0 ? c / q : low;
  if (low > high) std::swap(low, high);
  return true;
}

// A ball scaled along the axes of its frame.
Inside in_ellipsoid(const Ray& ray, const Vec3& center, const Vec3& semi_axes) {
  const Vec3 x = (ray.from - center).cwiseQuotient(semi_axes);
  const Vec3 d = ray.direction.cwiseQuotient(semi_axes);
  Inside inside;
  double low = 0, high = 0;
  if (!roots(d.squaredNorm(), x.dot(d), x.squaredNorm() - 1, low, high)) {
    inside.miss();
    return inside;
  }
  const Vec3 there = x + low * d;
  inside.enter(low, there.cwiseQuotient(semi_axes).normalized());
  inside.leave(high);
  return inside;
}

// |(x, y)| <= r(z) between two planes, r linear: q(s) = |(x, y)|^2 - r^2 <= 0, where r >= 0.
Inside in_frustum(const Ray& ray, const FrustumProfile& f) {
  Inside inside;
  clip_by_plane(ray, Vec3::UnitZ(), f.half_length, inside);
  clip_by_plane(ray, -Vec3::UnitZ(), f.half_length, inside);
  if (!(inside.from <= inside.to)) return inside;
  const double slope = 0.5 * (f.top_radius - f.radius) / f.half_length;
  const double radius = 0.5 * (f.top_radius + f.radius) + slope * ray.from.z();
  const Vec3 &x = ray.from, &d = ray.direction;
  const double widening = slope * d.z();
  const double a = d.x() * d.x() + d.y() * d.y() - widening * widening;
  const double b = x.x() * d.x() + x.y() * d.y() - widening * radius;
  const double c = x.x() * x.x() + x.y() * x.y() - radius * radius;
  const auto enter = [&](double s) {
    const Vec3 p = ray.at(s);
    const double across = std::hypot(p.x(), p.y());
    const SideNormal side(f);
    const Vec3 out = across > 0 ? Vec3(p.x() / across, p.y() / across, 0) : Vec3::UnitX();
    inside.enter(s, side.across * out + side.along * Vec3::UnitZ());
  };
  double low = 0, high = 0;
  if (a == 0) {
    if (b < 0)
      enter(-0.5 * c / b);
    else if (b > 0)
      inside.leave(-0.5 * c / b);
    else if (c > 0)
      inside.miss();
  } else if (!roots(a, b, c, low, high)) {
    if (a > 0) inside.miss();
  } else if (a > 0) {
    enter(low);
    inside.leave(high);
  } else if (low >= inside.from) {
    // steeper than the side: inside both cones that make the quadric, of which one is the frustum's
    inside.leave(low);
  } else {
    enter(high);
  }
  return inside;
}

// A cylinder between two balls.
Inside in_capsule(const Ray& ray, const ConvexPart& part) {
  FrustumProfile middle(part);
  middle.radius = middle.top_radius = part.margin;
  Inside all = in_frustum(ray, middle);
  for (const double end : {-part.half_length, part.half_length}) {
    const Inside ball = in_ellipsoid(ray, end * Vec3::UnitZ(), Vec3::Constant(part.margin));
    if (!(ball.from <= ball.to)) continue;
    if (!(all.from <= all.to)) {
      all = ball;
      continue;
    }
    if (ball.from < all.from) {
      all.from = ball.from;
      all.normal = ball.normal;
    }
    all.to = std::max(all.to, ball.to);
  }
  return all;
}

// In the part's frame, but for half-spaces, which are in the shape's.
Inside in_part(const Ray& ray, const ConvexPart& part) {
  Inside inside;
  switch (part.kind) {
    case PartKind::half_space: clip_by_plane(ray, part.normal, part.offset, inside); return inside;
    case PartKind::sphere: return in_ellipsoid(ray, Vec3::Zero(), Vec3::Constant(part.radius));
    case PartKind::ellipsoid: return in_ellipsoid(ray, Vec3::Zero(), part.semi_axes);
    case PartKind::frustum: return part.margin > 0 ? in_capsule(ray, part) : in_frustum(ray, part);
    case PartKind::polyhedron: break;
  }
  for (const Polyhedron::Face& face : part.core->faces())
    clip_by_plane(ray, face.normal, face.offset, inside);
  return inside;
}

// Where the ray enters the box, and a little before; infinity: not by `most`.
double entry_of(const Ray& ray, const Aabb& box, double most) {
  double from = 0, to = most;
  for (int i = 0; i < 3; ++i) {
    const double size = std::abs(box.lo[i]) + std::abs(box.hi[i]) + std::abs(ray.from[i]);
    const double slack = 1e-12 * size;
    const double low = box.lo[i] - slack - ray.from[i], high = box.hi[i] + slack - ray.from[i];
    if (ray.direction[i] == 0) {
      if (low > 0 || high < 0) return infinity;
      continue;
    }
    const double one = low / ray.direction[i], two = high / ray.direction[i];
    from = std::max(from, std::min(one, two));
    to = std::min(to, std::max(one, two));
  }
  return from <= to ? from : infinity;
}

}  // namespace

std::optional<RayHit> cast_ray(const Shape& shape, const Frame& frame, const Vec3& from,
                               const Vec3& direction, double most) {
  std::optional<RayHit> nearest;
  const auto try_part = [&](const ConvexPart& part) {
    const Frame place = part.kind == PartKind::half_space ? frame : part.in(frame);
    if (part.kind != PartKind::half_space) {
      // past the ball that holds it
      const Vec3 way = frame * part.bound_center - from;
      const double along = way.dot(direction), reach = part.bound_radius * (1 + 1e-12);
      if ((way - along * direction).norm() > reach || along < -reach) return;
    }
    const Ray ray{place.to_local(from), place.R.transpose() * direction};
    const Inside inside = in_part(ray, part);
    if (!(inside.from <= inside.to) || inside.to < 0) return;
    const double distance = std::max(inside.from, 0.0);
    if (distance > (nearest ? nearest->distance : most)) return;
    nearest = RayHit{distance, inside.from > 0 ? Vec3(place.R * inside.normal) : Vec3(-direction)};
  };
  if (!shape.tree()) {
    for (const ConvexPart& part : shape.parts()) try_part(part);
    return nearest;
  }
  const PartTree& tree = *shape.tree();
  const Ray ray{frame.to_local(from), frame.R.transpose() * direction};
  const auto entry = [&](const PartTree::Node& node) {
    return entry_of(ray, node.box, nearest ? nearest->distance : most);
  };
  const auto search = [&](const auto& again, const PartTree::Node& node) -> void {
    if (node.is_leaf) return try_part(shape.part(node.first));
    const PartTree::Node *first = &tree.node(node.first), *second = &tree.node(node.first + 1);
    double one = entry(*first), two = entry(*second);
    if (two < one) {
      std::swap(first, second);
      std::swap(one, two);
    }
    if (one < infinity) again(again, *first);
    // a hit in the first may be nearer than the second
    if (two < infinity && (!nearest || two <= nearest->distance)) again(again, *second);
  };
  if (entry(tree.root()) < infinity) search(search, tree.root());
  return nearest;
}

}  // namespace tw
