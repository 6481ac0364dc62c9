// Distance of two separate convex cores by GJK.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/gjk.h"

#include <algorithm>

#include "collision/distance/simplex.h"

namespace tw {

namespace {

// B as a polyhedron seen from A's frame.
struct PlacedCore {
  const Polyhedron& core;
  const Frame& placement;

  int support(const Vec3& direction, int start) const {
    return core.support(placement.R.transpose() * direction, start);
  }
  Vec3 vertex(int i) const { return placement * core.vertex(i); }
  Vec3 center() const { return placement * core.center(); }
};

// B as a single point.
struct PointCore {
  const Vec3& point;

  int support(const Vec3&, int) const { return 0; }
  const Vec3& vertex(int) const { return point; }
  const Vec3& center() const { return point; }
};

template <class CoreB>
SimplexPoint support_point(const Polyhedron& a, const CoreB& b, const Vec3& direction, int start_a,
                           int start_b) {
  SimplexPoint p;
  p.a = a.support(direction, start_a);
  p.b = b.support(-direction, start_b);
  p.w = a.vertex(p.a) - b.vertex(p.b);
  return p;
}

bool contains(const Simplex& simplex, const SimplexPoint& p) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
    if (simplex.points[i].a == p.a && simplex.points[i].b == p.b) return true;
  return false;
}

template <class CoreB>
Simplex start_simplex(const Polyhedron& a, const CoreB& b, const SimplexCache* cache) {
  Simplex simplex;
  if (cache != nullptr && cache->count > 0) {
    simplex.count = std::min(cache->count, 3);
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
      SimplexPoint& p = simplex.points[i];
      p.a = cache->vertex_a[i];
      p.b = cache->vertex_b[i];
      p.w = a.vertex(p.a) - b.vertex(p.b);
    }
  } else {
    simplex.count = 1;
    simplex.points[0] = support_point(a, b, b.center() - a.center(), 0, 0);
  }
  reduce(simplex);
  return simplex;
}

// Improves the simplex until nothing can be gained; true where it encloses the origin.
template <class CoreB>
bool descend(const Polyhedron& a, const CoreB& b, Simplex& best) {
  // of exact arithmetic GJK needs a handful of steps, and rounding ends it much before; steps in
  // all that may fail to shorten v
  constexpr int most_steps = 100, most_stalls = 6;
  // what support values can err by, relative to the size of the Minkowski difference
  constexpr double rounding = 4e-16;
  double scale = 0;  // squared size of the Minkowski difference
  for (std::size_t i = 0; i < static_cast<std::size_t>(best.count); ++i)
    scale = std::max(scale, best.points[i].w.squaredNorm());
  Simplex simplex = best;
  double least = best.v.squaredNorm();
  for (int step = 0, stalls = 0; step < most_steps && stalls < most_stalls; ++step) {
    const double square = simplex.v.squaredNorm();
    if (!(square > 0)) return true;
    const SimplexPoint next =
        support_point(a, b, -simplex.v, simplex.points[0].a, simplex.points[0].b);
    scale = std::max(scale, next.w.squaredNorm());
    // |v| - v.w/|v| bounds what can still be gained
    const double gain = square - simplex.v.dot(next.w);
    if (gain <= 0 || gain * gain <= rounding * rounding * scale * square) break;
    if (contains(simplex, next)) break;
    simplex.points[static_cast<std::size_t>(simplex.count++)] = next;
    if (reduce(simplex)) return true;
    const double reached = simplex.v.squaredNorm();
    if (reached < least) {
      least = reached;
      best = simplex;
    } else {
      // across nearly parallel faces a step may turn v without shortening it
      ++stalls;
    }
  }
  return false;
}

template <class CoreB>
CoreDistance distance_of(const Polyhedron& a, const CoreB& b, SimplexCache* cache) {
  Simplex simplex = start_simplex(a, b, cache);
  CoreDistance result;
  result.overlap = descend(a, b, simplex);
  if (cache != nullptr) {
    cache->count = result.overlap ? 0 : simplex.count;
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
      cache->vertex_a[i] = simplex.points[i].a;
      cache->vertex_b[i] = simplex.points[i].b;
    }
  }
  if (result.overlap) return result;
  // v = a - b
  result.distance = simplex.v.norm();
  if (result.distance > 0) result.normal = -simplex.v / result.distance;
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
    result.point_a += simplex.lambda[i] * a.vertex(simplex.points[i].a);
  return result;
}

}  // namespace

CoreDistance core_distance(const Polyhedron& a, const Polyhedron& b, const Frame& b_in_a,
                           SimplexCache* cache) {
  return distance_of(a, PlacedCore{b, b_in_a}, cache);
}

CoreDistance core_distance(const Polyhedron& a, const Vec3& point, SimplexCache* cache) {
  return distance_of(a, PointCore{point}, cache);
}

}  // namespace tw
