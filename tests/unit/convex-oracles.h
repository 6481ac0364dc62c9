// Random solids and poses, and slow independent answers about them, for tests of collision/.
//
// The oracles share nothing with the code under test: distance by all pairs of features, depth by
// all axes without pruning, overlap by libccd's portal refinement.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <ccd/ccd.h>

#include <algorithm>
#include <random>
#include <vector>

#include "geometry/polyhedron.h"
#include "geometry/shape.h"

namespace tw::test {

using Engine = std::mt19937_64;

inline double uniform(Engine& random, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}

inline Vec3 random_vector(Engine& random, double reach) {
  const double x = uniform(random, -reach, reach);
  const double y = uniform(random, -reach, reach);
  const double z = uniform(random, -reach, reach);
  return {x, y, z};
}

inline Vec3 random_direction(Engine& random) {
  for (;;) {
    const Vec3 v = random_vector(random, 1);
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

inline Quat random_rotation(Engine& random) {
  const Vec3 axis = random_direction(random);
  const double angle = uniform(random, 0, 2 * pi);
  return rotation_by(angle * axis).normalized();
}

inline Frame random_frame(Engine& random, double reach) {
  const Vec3 position = random_vector(random, reach);
  return Frame(Pose{position, random_rotation(random)});
}

// Points on a unit sphere, squeezed to `widths`.
inline ShapePtr random_rock(Engine& random, int points, const Vec3& widths) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < points; ++i) cloud.push_back(random_direction(random).cwiseProduct(widths));
  return make_hull(cloud);
}

// A regular prism: two polygons of many corners.
inline ShapePtr prism(int sides, double radius, double half_height) {
  std::vector<Vec3> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), half_height});
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), -half_height});
  }
  return make_hull(points);
}

// A polyhedron's features in the world.
struct WorldFeatures {
  std::vector<Vec3> vertices;
  std::vector<std::pair<Vec3, Vec3>> edges;
  std::vector<std::vector<Vec3>> faces;
  std::vector<Vec3> normals;

  WorldFeatures(const ConvexPart& part, const Frame& frame) {
    const Polyhedron& core = *part.core;
    const Frame world = part.in(frame);
    for (const Vec3& v : core.vertices()) vertices.push_back(world * v);
    for (const auto& e : core.edges())
      edges.emplace_back(world * core.vertex(e.tail), world * core.vertex(e.head));
    for (const auto& f : core.faces()) {
      std::vector<Vec3> corners;
      for (int i = 0; i < f.count; ++i)
        corners.push_back(world * core.vertex(core.corner(f.first + i)));
      faces.push_back(corners);
      normals.push_back(world.R * f.normal);
    }
  }
};

inline double point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + t * (b - a))).norm();
}

inline double point_polygon(const Vec3& p, const std::vector<Vec3>& polygon, const Vec3& normal) {
  bool inside = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    if (normal.cross(b - a).dot(p - a) < 0) inside = false;
  }
  return inside ? std::abs(normal.dot(p - polygon[0])) : 1e300;
}

// The distance where the two edges' interiors are nearest; huge where they aren't.
inline double crossing_distance(const std::pair<Vec3, Vec3>& a, const std::pair<Vec3, Vec3>& b) {
  const Vec3 u = a.second - a.first;
  const Vec3 v = b.second - b.first;
  const Vec3 n = u.cross(v);
  if (n.squaredNorm() < 1e-20 * u.squaredNorm() * v.squaredNorm()) return 1e300;
  const Vec3 r = b.first - a.first;
  const double s = r.cross(v).dot(n) / n.squaredNorm();
  const double t = r.cross(u).dot(n) / n.squaredNorm();
  if (s < 0 || s > 1 || t < 0 || t > 1) return 1e300;
  return std::abs(r.dot(n)) / n.norm();
}

// The distance of two separate polyhedra by all pairs of features.
inline double brute_distance(const WorldFeatures& a, const WorldFeatures& b) {
  double best = 1e300;
  const auto vertices_against = [&best](const WorldFeatures& p, const WorldFeatures& q) {
    for (const Vec3& v : p.vertices) {
      for (std::size_t f = 0; f < q.faces.size(); ++f)
        best = std::min(best, point_polygon(v, q.faces[f], q.normals[f]));
      for (const auto& e : q.edges) best = std::min(best, point_segment(v, e.first, e.second));
    }
  };
  vertices_against(a, b);
  vertices_against(b, a);
  for (const auto& ea : a.edges)
    for (const auto& eb : b.edges) best = std::min(best, crossing_distance(ea, eb));
  return best;
}

// Least n.x over b less greatest n.x over a.
inline double gap_along(const WorldFeatures& a, const WorldFeatures& b, const Vec3& n) {
  double top = -1e300;
  double bottom = 1e300;
  for (const Vec3& v : a.vertices) top = std::max(top, n.dot(v));
  for (const Vec3& v : b.vertices) bottom = std::min(bottom, n.dot(v));
  return bottom - top;
}

// The greatest gap over all face normals and edge crossings.
inline double brute_axis(const WorldFeatures& a, const WorldFeatures& b) {
  double best = -1e300;
  for (const Vec3& n : a.normals) best = std::max(best, gap_along(a, b, n));
  for (const Vec3& n : b.normals) best = std::max(best, gap_along(a, b, -n));
  for (const auto& ea : a.edges)
    for (const auto& eb : b.edges) {
      const Vec3 n = (ea.second - ea.first).cross(eb.second - eb.first);
      if (n.norm() < 1e-7 * (ea.second - ea.first).norm() * (eb.second - eb.first).norm()) continue;
      best = std::max(best, gap_along(a, b, n.normalized()));
      best = std::max(best, gap_along(a, b, -n.normalized()));
    }
  return best;
}

// libccd's answer whether two convex point sets overlap.
class CcdOracle {
 public:
  static bool overlap(const WorldFeatures& a, const WorldFeatures& b) {
    ccd_t ccd = settings();
    return ccdMPRIntersect(&a, &b, &ccd) != 0;
  }
  // An upper bound of the depth; negative where libccd sees no overlap.
  static double depth_bound(const WorldFeatures& a, const WorldFeatures& b) {
    ccd_t ccd = settings();
    ccd_real_t depth = 0;
    ccd_vec3_t direction, position;
    return ccdMPRPenetration(&a, &b, &ccd, &depth, &direction, &position) == 0 ? depth : -1;
  }

 private:
  static ccd_t settings() {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support;
    ccd.support2 = support;
    ccd.center1 = center;
    ccd.center2 = center;
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = 1e-10;
    return ccd;
  }
  static void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
    const auto& vertices = static_cast<const WorldFeatures*>(object)->vertices;
    const Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
    const Vec3* best = &vertices[0];
    for (const Vec3& v : vertices)
      if (v.dot(d) > best->dot(d)) best = &v;
    ccdVec3Set(point, best->x(), best->y(), best->z());
  }
  static void center(const void* object, ccd_vec3_t* point) {
    Vec3 sum = Vec3::Zero();
    const auto& vertices = static_cast<const WorldFeatures*>(object)->vertices;
    for (const Vec3& v : vertices) sum += v;
    sum /= static_cast<double>(vertices.size());
    ccdVec3Set(point, sum.x(), sum.y(), sum.z());
  }
};

// A zoo of polyhedra about a metre wide: boxes, plates, needles, rocks of 4 to 200 points, prisms.
inline std::vector<ShapePtr> polyhedron_zoo(Engine& random) {
  return {make_box({1, 1, 1}),
          make_box({2, 1, 0.05}),
          make_box({0.02, 0.03, 1.5}),
          make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
          random_rock(random, 8, {0.6, 0.5, 0.4}),
          random_rock(random, 24, {0.5, 0.7, 0.3}),
          random_rock(random, 64, {0.5, 0.5, 0.5}),
          random_rock(random, 20, {1, 0.6, 0.01}),
          prism(6, 0.5, 0.3),
          prism(20, 0.7, 0.02)};
}

}  // namespace tw::test
