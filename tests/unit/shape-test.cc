// Shapes: bounds, sizes, placing, unions and refused values.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "geometry/shape.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string error_of(const std::function<ShapePtr()>& make) {
  try {
    make();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Shape, bounds_of_turned_polyhedra_are_exact) {
  Engine random(1);
  for (const ShapePtr& shape : polyhedron_zoo(random))
    for (int i = 0; i < 20; ++i) {
      const Vec3 position = random_vector(random, 1);
      const ShapePtr placed = place_shape(shape, {position, random_rotation(random)});
      const Frame frame = random_frame(random, 3);
      Aabb truth;
      for (const Vec3& v : WorldFeatures(placed->parts()[0], frame).vertices) truth.add(v);
      const Aabb box = placed->bounds(frame);
      ASSERT_NEAR((box.lo - truth.lo).norm() + (box.hi - truth.hi).norm(), 0, 1e-14);
      ASSERT_LE(placed->parts()[0].bound_radius, 2.0);
      for (const Vec3& v : WorldFeatures(placed->parts()[0], Frame()).vertices)
        ASSERT_LE((v - placed->parts()[0].bound_center).norm(),
                  placed->parts()[0].bound_radius * (1 + 1e-15));
    }
}

TEST(Shape, bounds_of_a_union_hold_all_parts) {
  const ShapePtr pair =
      make_union({place_shape(make_sphere(1), {{2, 0, 0}, Quat::Identity()}), make_box({1, 1, 4})});
  const Aabb box = pair->bounds(Frame());
  EXPECT_EQ(box.lo, Vec3(-0.5, -1, -2));
  EXPECT_EQ(box.hi, Vec3(3, 1, 2));
  EXPECT_DOUBLE_EQ(pair->least_width(), 2);
  EXPECT_DOUBLE_EQ(pair->radius_about_origin(), 3);
  EXPECT_EQ(pair->kind_name(), "union");
  EXPECT_EQ(pair->parts().size(), 2u);
}

TEST(Shape, half_space_is_unbounded_except_along_its_own_axis) {
  const ShapePtr floor = make_half_space({0, 0, 5}, 0.25);
  EXPECT_FALSE(floor->bounded());
  EXPECT_TRUE(floor->is_half_space());
  EXPECT_EQ(floor->least_width(), infinity);
  EXPECT_EQ(floor->radius_about_origin(), infinity);
  EXPECT_EQ(floor->mass_properties().volume, 0);
  const Aabb box = floor->bounds(Frame(Mat3::Identity(), {0, 0, 1}));
  EXPECT_EQ(box.hi, Vec3(infinity, infinity, 1.25));
  EXPECT_EQ(box.lo, Vec3::Constant(-infinity));
  const ShapePtr slope = make_half_space({0, 1, 5}, 0.25);
  EXPECT_EQ(slope->bounds(Frame()).hi, Vec3::Constant(infinity));
}

TEST(Shape, placed_half_space_moves_its_plane) {
  Engine random(2);
  const Vec3 normal = random_direction(random);
  const Pose pose{random_vector(random, 2), random_rotation(random)};
  const ShapePtr plane = make_half_space(normal, 0.7);
  const ConvexPart moved = place_shape(plane, pose)->parts()[0];
  // a point of the plane stays on it
  const Vec3 point = 0.7 * normal + 3 * normal.unitOrthogonal();
  EXPECT_NEAR(moved.normal.dot(Frame(pose) * point) - moved.offset, 0, 1e-14);
}

TEST(Shape, placing_twice_is_placing_by_the_product) {
  Engine random(3);
  const Pose first{random_vector(random, 1), random_rotation(random)};
  const Pose second{random_vector(random, 1), random_rotation(random)};
  const ShapePtr rock = random_rock(random, 12, {1, 1, 1});
  const ConvexPart twice = place_shape(place_shape(rock, first), second)->parts()[0];
  const ConvexPart once = place_shape(rock, second * first)->parts()[0];
  EXPECT_NEAR((twice.placement().R - once.placement().R).norm(), 0, 1e-15);
  EXPECT_NEAR((twice.bound_center - once.bound_center).norm(), 0, 1e-15);
  // the core is shared, not copied
  EXPECT_EQ(twice.core, rock->parts()[0].core);
}

TEST(Shape, names_its_kind) {
  EXPECT_EQ(make_sphere(1)->kind_name(), "sphere");
  EXPECT_EQ(make_box({1, 1, 1})->kind_name(), "box");
  EXPECT_EQ(make_half_space({1, 0, 0}, 0)->kind_name(), "half-space");
  EXPECT_EQ(place_shape(make_sphere(1), Pose())->kind_name(), "sphere");
  EXPECT_TRUE(place_shape(make_sphere(1), {{1, 2, 3}, Quat::Identity()})->is_sphere());
  EXPECT_EQ(make_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})->kind_name(), "hull");
}

TEST(Shape, refuses_bad_values_by_name) {
  EXPECT_EQ(error_of([] { return make_sphere(-1); }),
            "the radius of a sphere is -1; expected a positive number of metres");
  EXPECT_EQ(error_of([] { return make_sphere(std::nan("")); }),
            "the radius of a sphere is NaN; expected a positive number of metres");
  EXPECT_EQ(error_of([] { return make_sphere(infinity); }),
            "the radius of a sphere is infinity; expected a positive number of metres");
  EXPECT_EQ(error_of([] {
              return make_box({1, 0, 1});
            }),
            "the y edge of a box is 0; expected a positive number of metres");
  EXPECT_EQ(error_of([] {
              return make_half_space({0, 0, 0}, 0);
            }),
            "the normal of a half-space is (0 0 0); expected a finite vector that isn't zero");
  EXPECT_EQ(error_of([] {
              return make_half_space({0, 0, 1}, infinity);
            }),
            "the offset of a half-space is infinity; expected a finite number");
  EXPECT_EQ(error_of([] { return make_union({}); }),
            "a union has no parts; expected at least one shape");
  EXPECT_EQ(error_of([] {
              return place_shape(make_sphere(1), {{0, std::nan(""), 0}, Quat::Identity()});
            }),
            "a shape is placed at (0 NaN 0); expected finite numbers");
  EXPECT_EQ(error_of([] {
              return place_shape(make_sphere(1), {{0, 0, 0}, Quat(0, 0, 0, 0)});
            }),
            "a shape is placed with a quaternion that is zero or not finite");
}

}  // namespace
}  // namespace tw::test
