// Convex hulls and polyhedra: topology, merging of coplanar faces, support, refused input.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/hull.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

std::string error_of(const std::vector<Vec3>& points) {
  try {
    convex_hull(points);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

std::vector<Vec3> cloud(Engine& random, int count, const Vec3& widths) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(random_vector(random, 1).cwiseProduct(widths));
  return points;
}

// Outward unit normals, corners on their planes, Gauss map of edges, all points inside.
void check_polyhedron(const Polyhedron& hull, const std::vector<Vec3>& points, double size) {
  ASSERT_EQ(hull.vertices().size() + hull.faces().size(), hull.edges().size() + 2);
  for (const auto& face : hull.faces()) {
    ASSERT_NEAR(face.normal.norm(), 1, 1e-15);
    ASSERT_LT(face.normal.dot(hull.center()) - face.offset, 1e-15 * size);
    for (int i = 0; i < face.count; ++i)
      ASSERT_NEAR(face.normal.dot(hull.vertex(hull.corner(face.first + i))) - face.offset, 0,
                  1e-13 * size);
    for (const Vec3& p : points) ASSERT_LE(face.normal.dot(p) - face.offset, 1e-13 * size);
  }
  for (const auto& edge : hull.edges()) {
    const Vec3 along = hull.vertex(edge.head) - hull.vertex(edge.tail);
    const Vec3 turn = hull.face(edge.left).normal.cross(hull.face(edge.right).normal);
    ASSERT_GE(turn.dot(along.normalized()), 0);
  }
}

TEST(Hull, of_random_points_is_closed_convex_and_holds_them) {
  Engine random(1);
  for (int round = 0; round < 60; ++round) {
    const double width = std::pow(10, uniform(random, -3, 0));
    const Vec3 widths(1, width, std::pow(10, uniform(random, -5, 0)));
    const auto points = cloud(random, 4 + round * 3, widths);
    check_polyhedron(convex_hull(points), points, 1);
  }
}

TEST(Hull, joins_coplanar_triangles_to_polygons) {
  // a lattice of points on and in a cube: only the corners and six squares remain
  std::vector<Vec3> lattice;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 4; ++y)
      for (int z = 0; z <= 4; ++z) lattice.push_back(0.1 * Vec3(x, y, z));
  const Polyhedron cube = convex_hull(lattice);
  EXPECT_EQ(cube.vertices().size(), 8u);
  EXPECT_EQ(cube.faces().size(), 6u);
  EXPECT_EQ(cube.edges().size(), 12u);
  check_polyhedron(cube, lattice, 1);
  // tilted, so that no coordinate is exact
  Engine random(2);
  const Frame tilt = random_frame(random, 3);
  for (Vec3& p : lattice) p = tilt * p;
  const Polyhedron tilted = convex_hull(lattice);
  EXPECT_EQ(tilted.vertices().size(), 8u);
  EXPECT_EQ(tilted.faces().size(), 6u);
  check_polyhedron(tilted, lattice, 1);
}

TEST(Hull, of_prisms_has_polygons_of_all_sides) {
  for (int sides : {3, 5, 16, 60}) {
    const ShapePtr shape = prism(sides, 0.5, 0.1);
    const Polyhedron& core = *shape->parts()[0].core;
    EXPECT_EQ(core.vertices().size(), static_cast<std::size_t>(2 * sides));
    EXPECT_EQ(core.faces().size(), static_cast<std::size_t>(sides + 2));
  }
}

TEST(Hull, is_the_same_for_the_same_points) {
  Engine random(3);
  const auto points = cloud(random, 100, {1, 1, 1});
  const Polyhedron first = convex_hull(points);
  const Polyhedron second = convex_hull(points);
  ASSERT_EQ(first.vertices(), second.vertices());
  ASSERT_EQ(first.faces().size(), second.faces().size());
  for (std::size_t f = 0; f < first.faces().size(); ++f) {
    ASSERT_EQ(first.faces()[f].normal, second.faces()[f].normal);
    for (int i = 0; i < first.faces()[f].count; ++i)
      ASSERT_EQ(first.corner(first.faces()[f].first + i),
                second.corner(second.faces()[f].first + i));
  }
}

TEST(Hull, far_from_the_origin_and_in_any_unit_keeps_its_faces) {
  Engine random(4);
  const auto points = cloud(random, 40, {1, 1, 1});
  const Polyhedron near = convex_hull(points);
  for (double unit : {1e-6, 1e6}) {
    std::vector<Vec3> scaled;
    for (const Vec3& p : points) scaled.push_back(unit * p + unit * Vec3(100, 0, -50));
    EXPECT_EQ(convex_hull(scaled).faces().size(), near.faces().size());
  }
}

TEST(Hull, duplicates_change_nothing) {
  Engine random(5);
  auto points = cloud(random, 20, {1, 1, 1});
  const Polyhedron once = convex_hull(points);
  const auto copy = points;
  points.insert(points.end(), copy.begin(), copy.end());
  const Polyhedron twice = convex_hull(points);
  EXPECT_EQ(once.vertices().size(), twice.vertices().size());
  EXPECT_EQ(once.faces().size(), twice.faces().size());
}

TEST(Hull, refuses_bad_points_and_says_how_flat_they_are) {
  EXPECT_EQ(error_of({}), "a hull needs at least 4 points; got 0");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "a hull needs at least 4 points; got 3");
  EXPECT_EQ(error_of({{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}, {0, 0, 1}}),
            "point 2 of a hull is (0 NaN 0); expected finite numbers");
  EXPECT_EQ(error_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}),
            "the 4 points of a hull all coincide; expected points that span a solid");
  EXPECT_NE(error_of({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}})
                .find("the 4 points of a hull are flat: 0 m thick, 1 m by 2 m wide"),
            std::string::npos)
      << error_of({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  EXPECT_NE(error_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).find("lie on a line"),
            std::string::npos);
}

TEST(Hull, refuses_flat_points_in_any_pose_without_a_word_on_the_terminal) {
  Engine random(6);
  ::testing::internal::CaptureStderr();
  for (int round = 0; round < 100; ++round) {
    const Frame frame = random_frame(random, 5);
    std::vector<Vec3> flat;
    for (int i = 0; i < 4 + round; ++i) {
      const double x = uniform(random, -1, 1);
      const double y = uniform(random, -1, 1);
      flat.push_back(frame * Vec3(x, y, 0));
    }
    ASSERT_NE(error_of(flat).find("flat"), std::string::npos);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Hull, accepts_plates_a_millionth_thick) {
  Engine random(7);
  const auto points = cloud(random, 50, {1, 1, 1e-6});
  check_polyhedron(convex_hull(points), points, 1);
}

TEST(Polyhedron, support_is_the_farthest_vertex_from_any_start) {
  Engine random(8);
  for (const ShapePtr& shape : polyhedron_zoo(random)) {
    const Polyhedron& core = *shape->parts()[0].core;
    const int count = static_cast<int>(core.vertices().size());
    for (int i = 0; i < 500; ++i) {
      const Vec3 direction = random_direction(random);
      const int start = static_cast<int>(random() % static_cast<unsigned>(count));
      double highest = -1e300;
      for (const Vec3& v : core.vertices()) highest = std::max(highest, v.dot(direction));
      ASSERT_NEAR(core.extent(direction, start), highest, 1e-15);
    }
  }
}

TEST(Polyhedron, faces_under_a_point_are_those_whose_planes_it_is_over) {
  Engine random(5);
  for (int round = 0; round < 50; ++round) {
    const auto hull = convex_hull(cloud(random, 20, Vec3(1, 1, 1)));
    const Vec3 point = random_vector(random, 1.5);
    const double height = uniform(random, -1, 1);
    std::vector<int> found, expected;
    hull.faces_under(point, height, found);
    for (int f = 0; f < static_cast<int>(hull.faces().size()); ++f)
      if (hull.face(f).normal.dot(point) - hull.face(f).offset >= height) expected.push_back(f);
    EXPECT_EQ(found, expected);
  }
}

TEST(Polyhedron, centre_is_inside_also_where_the_middle_of_the_box_is_not) {
  const Polyhedron corner = convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  int face = 0;
  EXPECT_LT(corner.face_separation(corner.center(), face), 0);
  EXPECT_NEAR(corner.inner_radius(), -corner.face_separation(corner.center(), face), 1e-16);
  for (const Vec3& v : corner.vertices()) EXPECT_LE((v - corner.center()).norm(), corner.radius());
}

TEST(Polyhedron, refuses_faces_that_leave_a_hole_or_are_not_convex) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(Polyhedron(corners, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}), UserError);
  EXPECT_NO_THROW(Polyhedron(corners, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
  // inside out
  EXPECT_THROW(Polyhedron(corners, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}), UserError);
}

}  // namespace
}  // namespace tw::test
