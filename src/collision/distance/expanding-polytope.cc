// The depth of the origin in a Minkowski difference, by an expanding polytope.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/expanding-polytope.h"

#include <algorithm>
#include <vector>

namespace tw {

namespace {

// A triangle of the polytope, counter-clockwise from outside.
struct Facet {
  std::array<int, 3> corner{};
  Vec3 normal = Vec3::Zero();
  double distance = 1e300;  // of its plane from the origin; huge where it has no area
};

struct Side {
  int tail, head;
};

class Polytope {
 public:
  Polytope(const std::array<DifferencePoint, 4>& enclosing, double rounding)
      : points_(enclosing.begin(), enclosing.end()), rounding_(rounding) {
    for (const std::array<int, 3>& corner :
         {std::array{0, 1, 2}, std::array{0, 2, 3}, std::array{0, 3, 1}, std::array{1, 3, 2}})
      add_facet(corner);
    // the fourth point is behind the first facet, or all are inside out
    const Facet& first = facets_[0];
    if (first.normal.dot(points_[3].w - points_[0].w) > 0)
      for (Facet& f : facets_) f = facet_of({f.corner[0], f.corner[2], f.corner[1]});
  }
  const Facet& nearest() const {
    return *std::min_element(facets_.begin(), facets_.end(),
                             [](const auto& f, const auto& g) { return f.distance < g.distance; });
  }
  // Replaces the facets that see the point.  False where rounding leaves no clean outline of them.
  bool add(const DifferencePoint& point) {
    const int number = static_cast<int>(points_.size());
    points_.push_back(point);
    sides_.clear();
    std::size_t kept = 0;
    for (const Facet& f : facets_) {
      const Vec3& corner = points_[static_cast<std::size_t>(f.corner[0])].w;
      if (f.normal.dot(point.w - corner) > rounding_)
        for (std::size_t k = 0; k < 3; ++k) add_side({f.corner[k], f.corner[(k + 1) % 3]});
      else
        facets_[kept++] = f;
    }
    facets_.resize(kept);
    if (!is_loop()) return false;
    for (const Side& side : sides_) add_facet({side.tail, side.head, number});
    return true;
  }
  // The point of A under the origin's foot on the facet.
  Vec3 foot_on_a(const Facet& f) const {
    const auto& p = points_[static_cast<std::size_t>(f.corner[0])];
    const auto& q = points_[static_cast<std::size_t>(f.corner[1])];
    const auto& r = points_[static_cast<std::size_t>(f.corner[2])];
    const Vec3 foot = f.distance * f.normal;
    const double area = f.normal.dot((q.w - p.w).cross(r.w - p.w));
    const double of_q = f.normal.dot((foot - p.w).cross(r.w - p.w)) / area;
    const double of_r = f.normal.dot((q.w - p.w).cross(foot - p.w)) / area;
    return (1 - of_q - of_r) * p.on_a + of_q * q.on_a + of_r * r.on_a;
  }

 private:
  Facet facet_of(const std::array<int, 3>& corner) const {
    Facet f;
    f.corner = corner;
    const Vec3& p = points_[static_cast<std::size_t>(corner[0])].w;
    const Vec3 u = points_[static_cast<std::size_t>(corner[1])].w - p;
    const Vec3 v = points_[static_cast<std::size_t>(corner[2])].w - p;
    const Vec3 n = u.cross(v);
    const double area = n.norm();
    if (!(area > 1e-15 * u.norm() * v.norm())) return f;
    f.normal = n / area;
    // the corner nearest to the origin's foot errs least; any is within rounding
    f.distance = f.normal.dot(p);
    return f;
  }
  void add_facet(const std::array<int, 3>& corner) { facets_.push_back(facet_of(corner)); }
  // Whether the outline passes every point once.
  bool is_loop() const {
    for (std::size_t i = 0; i < sides_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (sides_[i].tail == sides_[j].tail || sides_[i].head == sides_[j].head) return false;
    return sides_.size() >= 3;
  }
  // Sides that two removed facets share cancel each other.
  void add_side(const Side& side) {
    const auto twin = std::find_if(sides_.begin(), sides_.end(), [&side](const Side& s) {
      return s.tail == side.head && s.head == side.tail;
    });
    if (twin != sides_.end())
      sides_.erase(twin);
    else
      sides_.push_back(side);
  }

  std::vector<DifferencePoint> points_;
  std::vector<Facet> facets_;
  std::vector<Side> sides_;
  double rounding_;
};

}  // namespace

PolytopeDepth polytope_depth(const SupportCore& a, const SupportCore& b, const Vec3& shift,
                             const std::array<DifferencePoint, 4>& enclosing, double tolerance) {
  constexpr int most_steps = 200;
  Polytope polytope(enclosing, 1e-15 * (a.size() + b.size()));
  PolytopeDepth best;
  best.depth = 1e300;
  for (int step = 0; step < most_steps; ++step) {
    const Facet facet = polytope.nearest();
    if (!(facet.distance < best.depth)) break;
    const DifferencePoint point = difference_support(a, b, shift, facet.normal);
    const double reach = facet.normal.dot(point.w);
    if (reach < best.depth) {
      best.depth = reach;
      best.normal = facet.normal;
      best.on_a = polytope.foot_on_a(facet);
    }
    best.uncertainty = best.depth - facet.distance;
    if (reach - facet.distance <= tolerance || best.uncertainty <= tolerance) break;
    if (!polytope.add(point)) break;
  }
  return best;
}

}  // namespace tw
