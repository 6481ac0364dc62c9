// Volume integrals against closed forms, invariances and decompositions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/mass-properties.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "convex-oracles.h"

namespace tw::test {
namespace {

void expect_equal(const MassProperties& a, const MassProperties& b, double tolerance) {
  EXPECT_NEAR(a.volume, b.volume, tolerance * b.volume);
  EXPECT_NEAR((a.centroid - b.centroid).norm(), 0, tolerance);
  EXPECT_NEAR((a.inertia - b.inertia).norm(), 0, tolerance * b.inertia.norm());
}

TEST(MassProperties, of_a_sphere) {
  const MassProperties m = make_sphere(2)->mass_properties();
  EXPECT_NEAR(m.volume, 32.0 / 3 * pi, 1e-14);
  EXPECT_NEAR(m.inertia(1, 1), 0.4 * m.volume * 4, 1e-13);
  EXPECT_EQ(m.inertia(0, 1), 0);
}

TEST(MassProperties, of_a_box_and_of_its_hull_agree) {
  const Vec3 edges(0.4, 1.5, 2.5);
  const MassProperties box = make_box(edges)->mass_properties();
  EXPECT_DOUBLE_EQ(box.volume, 1.5);
  EXPECT_DOUBLE_EQ(box.inertia(0, 0), 1.5 / 12 * (1.5 * 1.5 + 2.5 * 2.5));
  EXPECT_DOUBLE_EQ(box.inertia(2, 2), 1.5 / 12 * (0.4 * 0.4 + 1.5 * 1.5));
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(0.5 * Vec3((i & 1) ? 0.4 : -0.4, (i & 2) ? 1.5 : -1.5, (i & 4) ? 2.5 : -2.5));
  expect_equal(make_hull(corners)->mass_properties(), box, 1e-15);
}

TEST(MassProperties, of_a_corner_tetrahedron) {
  // x, y, z >= 0, x + y + z <= 1: V = 1/6, centroid 1/4, integral x^2 = 1/60, integral xy = 1/120
  const MassProperties m =
      make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})->mass_properties();
  EXPECT_NEAR(m.volume, 1.0 / 6, 1e-16);
  EXPECT_NEAR((m.centroid - Vec3::Constant(0.25)).norm(), 0, 1e-16);
  const double square = 1.0 / 60 - 1.0 / 6 / 16;
  const double product = 1.0 / 120 - 1.0 / 6 / 16;
  EXPECT_NEAR(m.inertia(0, 0), 2 * square, 1e-17);
  EXPECT_NEAR(m.inertia(0, 1), -product, 1e-17);
}

TEST(MassProperties, of_a_regular_octahedron) {
  // vertices at distance a on the axes: V = 4/3 a^3, I = V a^2 / 5
  const double a = 0.7;
  std::vector<Vec3> corners;
  for (int axis = 0; axis < 3; ++axis) {
    corners.push_back(a * Vec3::Unit(axis));
    corners.push_back(-a * Vec3::Unit(axis));
  }
  const MassProperties m = make_hull(corners)->mass_properties();
  EXPECT_NEAR(m.volume, 4.0 / 3 * a * a * a, 1e-15);
  EXPECT_NEAR((m.inertia - m.volume * a * a / 5 * Mat3::Identity()).norm(), 0, 1e-16);
}

TEST(MassProperties, of_a_rock_do_not_depend_on_where_it_stands) {
  Engine random(1);
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) points.push_back(random_vector(random, 1));
  const MassProperties here = make_hull(points)->mass_properties();
  const Quat turn = random_rotation(random);
  const Frame move(Pose{Vec3(3, -2, 5), turn});
  for (Vec3& p : points) p = move * p;
  expect_equal(make_hull(points)->mass_properties(), placed_mass(here, move), 5e-14);
}

TEST(MassProperties, of_two_halves_add_up_to_the_whole) {
  const ShapePtr half = make_box({1, 2, 3});
  const ShapePtr whole = make_union({place_shape(half, {{-0.5, 0, 0}, Quat::Identity()}),
                                     place_shape(half, {{0.5, 0, 0}, Quat::Identity()})});
  expect_equal(whole->mass_properties(), make_box({2, 2, 3})->mass_properties(), 1e-15);
}

TEST(MassProperties, of_a_dumbbell_have_the_parallel_axes) {
  const ShapePtr ball = make_sphere(0.5);
  const ShapePtr dumbbell = make_union({place_shape(ball, {{0, 0, 2}, Quat::Identity()}),
                                        place_shape(ball, {{0, 0, -1}, Quat::Identity()})});
  const MassProperties& m = dumbbell->mass_properties();
  const MassProperties& one = ball->mass_properties();
  EXPECT_NEAR((m.centroid - Vec3(0, 0, 0.5)).norm(), 0, 1e-16);
  EXPECT_NEAR(m.inertia(2, 2), 2 * one.inertia(2, 2), 1e-15);
  EXPECT_NEAR(m.inertia(0, 0), 2 * (one.inertia(0, 0) + one.volume * 1.5 * 1.5), 1e-14);
}

TEST(MassProperties, inertia_is_symmetric_to_the_last_bit_and_a_solid_s) {
  Engine random(2);
  for (const ShapePtr& shape : polyhedron_zoo(random)) {
    const Vec3 position = random_vector(random, 2);
    const ShapePtr placed = place_shape(shape, {position, random_rotation(random)});
    const Mat3 inertia = placed->mass_properties().inertia;
    EXPECT_EQ(inertia, inertia.transpose().eval());
    // the sum of two principal moments exceeds the third
    const Vec3 moments = inertia.eigenvalues().real();
    EXPECT_GT(moments.minCoeff(), 0);
    EXPECT_GE(moments.sum() - 2 * moments.maxCoeff(), -1e-15);
  }
}

}  // namespace
}  // namespace tw::test
