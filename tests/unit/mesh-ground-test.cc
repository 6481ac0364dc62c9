// Meshes as ground: what is solid, against distances from all triangles one by one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/mesh-ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "collision/distance/separation.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

struct Surface {
  std::vector<Vec3> points;
  std::vector<MeshTriangle> triangles;

  void add_cell(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
};

Surface cube(double edge) {
  Surface s;
  for (int i = 0; i < 8; ++i)
    s.points.emplace_back((i & 1) * edge, (i >> 1 & 1) * edge, (i >> 2) * edge);
  s.add_cell(0, 2, 3, 1);
  s.add_cell(4, 5, 7, 6);
  s.add_cell(0, 1, 5, 4);
  s.add_cell(2, 6, 7, 3);
  s.add_cell(0, 4, 6, 2);
  s.add_cell(1, 3, 7, 5);
  return s;
}

// About z; the tube's middle is at `major`.
Surface torus(double major, double minor, std::uint32_t around, std::uint32_t along) {
  Surface s;
  for (std::uint32_t j = 0; j < along; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * j / along, b = 2 * std::numbers::pi * i / around;
      const double q = major + minor * std::cos(b);
      s.points.emplace_back(q * std::cos(a), q * std::sin(a), minor * std::sin(b));
    }
  for (std::uint32_t j = 0; j < along; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t k = (i + 1) % around, l = (j + 1) % along;
      s.add_cell(i + j * around, i + l * around, k + l * around, k + j * around);
    }
  return s;
}

// n by n cells of a square with a middle at the origin, heights up to `rough`.
Surface sheet(Engine& random, std::uint32_t n, double rough) {
  Surface s;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i)
      s.points.emplace_back(i - 0.5 * n, j - 0.5 * n, uniform(random, -rough, rough));
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = i + j * (n + 1);
      s.add_cell(a, a + 1, a + n + 2, a + n + 1);
    }
  return s;
}

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm();
}

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 foot = x - n.dot(x - a) * n;
  const bool over = n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 &&
                    n.dot((a - c).cross(foot - c)) >= 0;
  if (over) return (x - foot).norm();
  return std::min(
      {distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

double distance_to_surface(const Vec3& x, const Surface& s) {
  double least = 1e9;
  for (const auto& [a, b, c] : s.triangles)
    least = std::min(least, distance_to_triangle(x, s.points[a], s.points[b], s.points[c]));
  return least;
}

// Negative inside.
double distance_to_point(const Shape& shape, const Vec3& x) {
  static const ShapePtr probe = make_sphere(1e-6);
  return signed_distance(shape, Frame(), *probe, Frame(Mat3::Identity(), x)) + 1e-6;
}

double area(const MeshFaces& mesh) {
  double all = 0;
  for (const MeshFace& face : mesh.faces)
    for (std::size_t i = 2; i < face.corners.size(); ++i) {
      const Vec3& a = mesh.points[face.corners[0]];
      all +=
          0.5 * face.normal.dot(
                    (mesh.points[face.corners[i - 1]] - a).cross(mesh.points[face.corners[i]] - a));
    }
  return all;
}

TEST(MeshFaces, triangles_in_one_plane_are_joined) {
  MeshFaults faults;
  const Surface s = cube(2);
  const MeshFaces mesh = mesh_faces(s.points, s.triangles, faults);
  ASSERT_EQ(mesh.faces.size(), 6u);
  for (const MeshFace& face : mesh.faces) {
    EXPECT_EQ(face.corners.size(), 4u);
    // away from the middle
    EXPECT_NEAR(face.offset - face.normal.sum(), 1, 1e-15);
  }
  EXPECT_EQ(faults.open_sides, 0u);
}

TEST(MeshFaces, a_plane_of_any_triangles_is_one_face) {
  Engine random(2);
  MeshFaults faults;
  const Surface s = sheet(random, 30, 0);
  EXPECT_EQ(mesh_faces(s.points, s.triangles, faults).faces.size(), 1u);
  EXPECT_EQ(faults.open_sides, 120u);
}

TEST(MeshFaces, around_a_hole_they_are_convex_and_neighbours_of_each_other) {
  Engine random(3);
  for (int round = 0; round < 20; ++round) {
    Surface s = sheet(random, 12, 0);
    std::erase_if(s.triangles, [&](const MeshTriangle&) { return uniform(random, 0, 1) < 0.15; });
    MeshFaults faults;
    const MeshFaces mesh = mesh_faces(s.points, s.triangles, faults);
    EXPECT_LT(mesh.faces.size(), s.triangles.size() / 2);
    EXPECT_NEAR(area(mesh), 0.5 * static_cast<double>(s.triangles.size()), 1e-9);
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.faces.size()); ++i) {
      const MeshFace& face = mesh.faces[static_cast<std::size_t>(i)];
      const std::size_t n = face.corners.size();
      for (std::size_t k = 0; k < n; ++k) {
        const Vec3& a = mesh.points[face.corners[k]];
        const Vec3& b = mesh.points[face.corners[(k + 1) % n]];
        const Vec3& c = mesh.points[face.corners[(k + 2) % n]];
        EXPECT_GE((b - a).cross(c - b).z(), -1e-9);
        if (face.neighbours[k] == MeshFace::none) continue;
        const MeshFace& other = mesh.faces[static_cast<std::size_t>(face.neighbours[k])];
        const auto back = std::find(other.neighbours.begin(), other.neighbours.end(), i);
        EXPECT_NE(back, other.neighbours.end());
      }
    }
  }
}

TEST(MeshFaces, what_is_wrong_with_triangles_is_counted) {
  MeshFaults faults;
  Surface s = cube(1);
  std::swap(s.triangles[3][1], s.triangles[3][2]);  // turned
  s.triangles.push_back(s.triangles[5]);            // doubled
  s.triangles.push_back({s.triangles[6][1], s.triangles[6][0], s.triangles[6][2]});
  s.points.push_back(0.5 * (s.points[0] + s.points[1]));
  s.triangles.push_back({0, 1, 8});                    // thin
  s.points.push_back(s.points[0] + Vec3(1e-9, 0, 0));  // the same point
  s.triangles[0][0] = 9;
  s.points.emplace_back(-1, -1, -1);
  s.triangles.push_back({0, 1, 10});  // a fin
  EXPECT_EQ(mesh_faces(s.points, s.triangles, faults).faces.size(), 7u);
  EXPECT_EQ(faults.thin, 1u);
  EXPECT_EQ(faults.doubled, 2u);
  EXPECT_EQ(faults.back_to_back, 1u);
  EXPECT_EQ(faults.turned, 1u);
  EXPECT_EQ(faults.crowded_sides, 1u);
  EXPECT_EQ(faults.open_sides, 2u);
}

// Also of what is told as ground: a room is a surface that looks inwards.
TEST(MeshGround, distances_outside_are_those_of_its_triangles) {
  Engine random(4);
  for (const Surface& s : {torus(2, 0.7, 9, 14), cube(2), sheet(random, 8, 0.7)}) {
    const ShapePtr shape = make_mesh(s.points, s.triangles);
    const MeshGround& ground = *shape->mesh();
    for (int i = 0; i < 400; ++i) {
      // over a triangle's middle and beside it
      const MeshTriangle& t = s.triangles[static_cast<std::size_t>(
          uniform(random, 0, static_cast<double>(s.triangles.size())))];
      const Vec3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
      const Vec3 normal = (b - a).cross(c - a).normalized();
      const double u = uniform(random, 0, 1), v = uniform(random, 0, 1 - u);
      const Vec3 foot = a + u * (b - a) + v * (c - a);
      const double high = uniform(random, 0, 0.15), deep = uniform(random, 1e-6, 2e-3);
      const Vec3 over = foot + high * normal;
      EXPECT_NEAR(distance_to_point(*shape, over), distance_to_surface(over, s), 1e-9);
      EXPECT_LT(distance_to_point(*shape, foot - deep * normal), 1e-9);
    }
    EXPECT_GT(ground.thickness(), 0.3);
  }
}

TEST(MeshGround, a_thin_wall_does_not_come_out_behind) {
  // a plate of 1 cm, of large polygons and of small ones
  for (const std::uint32_t n : {1u, 20u}) {
    Engine random(5);
    Surface s = sheet(random, n, 0);
    for (Vec3& p : s.points) p *= 1.0 / n;
    const auto top = static_cast<std::uint32_t>(s.points.size());
    const std::size_t one_side = s.triangles.size();
    for (std::uint32_t i = 0; i < top; ++i) s.points.push_back(s.points[i] - Vec3(0, 0, 0.01));
    for (std::size_t i = 0; i < one_side; ++i) {
      const auto [a, b, c] = s.triangles[i];
      s.triangles.push_back({a + top, c + top, b + top});
    }
    const ShapePtr shape = make_mesh(s.points, s.triangles);
    EXPECT_NEAR(shape->mesh()->thickness(), 0.01, 1e-6);
    for (const double z : {1e-4, 1e-3, -0.0101, -0.012})
      EXPECT_NEAR(distance_to_point(*shape, Vec3(0.11, 0.07, z)), std::max(z, -0.01 - z), 1e-9);
    EXPECT_LT(distance_to_point(*shape, Vec3(0.11, 0.07, -0.003)), 0);
    EXPECT_LT(distance_to_point(*shape, Vec3(0.11, 0.07, -0.007)), 0);
  }
}

TEST(MeshGround, a_plate_is_as_thick_as_it_is_however_wide) {
  for (const double wide : {1.0, 10.0, 1000.0, 20000.0}) {
    Surface s = cube(1);
    for (Vec3& p : s.points) p = Vec3(wide * (p.x() - 0.5), wide * (p.y() - 0.5), 0.1 * p.z());
    const ShapePtr shape = make_mesh(s.points, s.triangles);
    for (const double z : {0.11, 0.15, 0.4, -0.01, -0.3})
      EXPECT_NEAR(distance_to_point(*shape, Vec3(0.011, 0.007, z)), std::max(z - 0.1, -z), 1e-6);
    EXPECT_LT(distance_to_point(*shape, Vec3(0.011, 0.007, 0.09)), 0);
  }
}

TEST(MeshGround, a_finely_divided_bend_has_no_ground_beside_it) {
  Surface s;
  const std::uint32_t steps = 900;
  for (std::uint32_t i = 0; i <= steps; ++i)
    for (const double r : {100.0, 104.0}) {
      const double a = 1e-3 * i;
      s.points.emplace_back(1000 + r * std::cos(a), r * std::sin(a), 0);
    }
  for (std::uint32_t i = 0; i < steps; ++i) s.add_cell(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2);
  const ShapePtr shape = make_mesh(s.points, s.triangles);
  for (const double a : {0.1, 0.3, 0.5, 0.7}) {
    const auto at = [&](double r) { return Vec3(1000 + r * std::cos(a), r * std::sin(a), 0.5); };
    EXPECT_NEAR(distance_to_point(*shape, at(102)), 0.5, 1e-6);
    EXPECT_NEAR(distance_to_point(*shape, at(99.5)), std::hypot(0.5, 0.5), 1e-4);
  }
}

// Top and underside have one corner in common and no side; and a ridge that is divided on one side.
TEST(MeshGround, faces_that_share_a_corner_part_what_is_between_them) {
  const Surface plate{{{0, 0, 0}, {1, -0.4, 0}, {1, 0.4, 0}, {1, -0.4, -0.05}, {1, 0.4, -0.05}},
                      {{0, 1, 2}, {0, 4, 3}, {1, 3, 4}, {1, 4, 2}, {0, 3, 1}, {0, 2, 4}}};
  const Surface wedge{
      {{0, 0, 1}, {1, 0, 1}, {0.5, 0, 1}, {0, -0.15, 0}, {1, -0.15, 0}, {0, 0.15, 0}, {1, 0.15, 0}},
      {{0, 3, 4},
       {0, 4, 1},
       {0, 2, 5},
       {2, 1, 6},
       {2, 6, 5},
       {0, 5, 3},
       {1, 4, 6},
       {3, 5, 6},
       {3, 6, 4}}};
  Engine random(7);
  for (const Surface& s : {plate, wedge}) {
    const ShapePtr shape = make_mesh(s.points, s.triangles);
    Aabb box;
    for (const Vec3& p : s.points) box.add(p);
    box.grow(0.1);
    for (int i = 0; i < 1000; ++i) {
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = uniform(random, box.lo[k], box.hi[k]);
      double above = -1e9;  // both are convex
      for (const auto& [a, b, c] : s.triangles) {
        const Vec3 normal =
            (s.points[b] - s.points[a]).cross(s.points[c] - s.points[a]).normalized();
        above = std::max(above, normal.dot(x - s.points[a]));
      }
      if (above > 1e-6) {
        EXPECT_NEAR(distance_to_point(*shape, x), distance_to_surface(x, s), 1e-6);
      }
    }
  }
}

TEST(MeshGround, far_from_the_origin_and_beside_unused_points_it_is_the_same) {
  Engine random(8);
  const Surface s = sheet(random, 6, 0.3);
  const ShapePtr near = make_mesh(s.points, s.triangles);
  Surface far = s;
  for (Vec3& p : far.points) p += Vec3(1 << 20, 0, 0);
  const ShapePtr moved = make_mesh(far.points, far.triangles);
  far = s;
  far.points.emplace_back(1e12, 0, 0);
  const ShapePtr beside = make_mesh(far.points, far.triangles);
  for (int i = 0; i < 100; ++i) {
    const Vec3 x(uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, 0.3, 1));
    EXPECT_NEAR(distance_to_point(*moved, x + Vec3(1 << 20, 0, 0)), distance_to_point(*near, x),
                1e-6);
    EXPECT_EQ(distance_to_point(*beside, x), distance_to_point(*near, x));
  }
}

TEST(MeshGround, beside_a_height_field_distances_are_those_of_their_parts) {
  const Surface s = cube(1);
  const ShapePtr mesh = make_mesh(s.points, s.triangles);
  const ShapePtr field = make_height_field({0, 0, 0, 0, 0, 0, 0, 0, 0}, 3, 1, 1);
  const Frame above(Mat3::Identity(), Vec3(0, 0, 2));
  EXPECT_NEAR(signed_distance(*mesh, above, *field, Frame()), 2, 1e-9);
  EXPECT_NEAR(signed_distance(*field, Frame(), *mesh, above), 2, 1e-9);
  EXPECT_NEAR(signed_distance(*field, Frame(), *field, above), 1, 1e-9);
}

TEST(MeshGround, any_triangles_make_parts) {
  Engine random(6);
  for (int round = 0; round < 60; ++round) {
    Surface s;
    const double flat = std::pow(10, uniform(random, -9, 0));
    for (int i = 0; i < 24; ++i)
      s.points.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1),
                            flat * uniform(random, -1, 1));
    for (int i = 0; i < 60; ++i) {
      MeshTriangle t;
      for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(uniform(random, 0, 24));
      s.triangles.push_back(t);
    }
    MeshFaults faults;
    const ShapePtr shape = make_mesh(s.points, s.triangles, &faults);
    for (std::size_t i = 0; i < shape->part_count(); ++i) {
      const ConvexPart& part = shape->part(i);
      const Aabb box = part_bounds(part, Frame());
      EXPECT_TRUE(shape->tree()->root().box.overlaps(box));
      EXPECT_LT(box.size().norm(), 40);
    }
  }
}

TEST(MeshGround, says_what_it_cannot_be) {
  EXPECT_THROW(make_mesh({}, {}), UserError);
  const std::vector<Vec3> in_a_line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_THROW(make_mesh(in_a_line, {{0, 1, 2}}), UserError);
  EXPECT_THROW(make_mesh(in_a_line, {{0, 1, 3}}), UserError);
  EXPECT_THROW(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}), UserError);
}

}  // namespace
}  // namespace tw::test
