// Rays against the distance of the points along them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/ray.h"

#include <gtest/gtest.h>

#include "collision/distance/separation.h"
#include "convex-oracles.h"

namespace tw::test {
namespace {

// The signed distance of a point.
double height(const Shape& shape, const Frame& frame, const Vec3& point) {
  constexpr double tiny = 1e-9;
  static const ShapePtr probe = make_sphere(tiny);
  return separation(shape, frame, *probe, Frame(Mat3::Identity(), point)).distance + tiny;
}

// Up to the hit the ray is outside, at the hit on the surface, a little farther inside; a ray that
// misses is outside all the way.
TEST(Ray, meets_every_kind_of_shape_first_where_it_enters) {
  Engine random(1);
  std::vector<ShapePtr> zoo = polyhedron_zoo(random);
  for (const ShapePtr& shape :
       {make_sphere(0.5), make_cylinder(0.5, 1), make_cylinder(0.03, 1.5), make_capsule(0.2, 1),
        make_cone(0.5, 1), make_cone(0.6, 0.1), make_ellipsoid({0.5, 0.3, 0.2}),
        make_ellipsoid({0.6, 0.6, 0.06}), make_half_space({1, 2, 3}, 0.1),
        make_union({make_box({1, 0.2, 0.2}),
                    place_shape(make_cone(0.3, 1), Pose{{0.4, 0, 0.1}, rotation_by({1, 0, 0})})})})
    zoo.push_back(shape);
  int hits = 0, misses = 0;
  for (int i = 0; i < 400; ++i)
    for (const ShapePtr& shape : zoo) {
      const Frame frame = random_frame(random, 0.5);
      const Vec3 from = 2 * random_direction(random);
      const Vec3 to = i % 2 ? 0.5 * random_direction(random) : Vec3(1.5 * random_direction(random));
      const Vec3 way = (to - from).normalized();
      const auto hit = cast_ray(*shape, frame, from, way, 4);
      const bool begins_inside = height(*shape, frame, from) <= 0;
      if (begins_inside) {
        ASSERT_TRUE(hit.has_value());
        ASSERT_EQ(hit->distance, 0);
        ASSERT_EQ(hit->normal, -way);
        continue;
      }
      const double end = hit ? hit->distance : 4;
      // what grazes is either
      for (int k = 0; k < 40; ++k)
        ASSERT_GT(height(*shape, frame, from + k / 40.0 * end * way), -1e-8) << shape->kind_name();
      if (!hit) {
        ++misses;
        continue;
      }
      ++hits;
      const Vec3 point = from + hit->distance * way;
      ASSERT_NEAR(height(*shape, frame, point), 0, 1e-8) << shape->kind_name();
      ASSERT_NEAR(hit->normal.norm(), 1, 1e-12);
      ASSERT_LT(hit->normal.dot(way), 1e-9);
      // the normal leads away from the surface as fast as anything does
      if (shape->parts().size() == 1 && hit->normal.dot(way) < -1e-3) {
        ASSERT_NEAR(height(*shape, frame, point + 1e-5 * hit->normal), 1e-5, 2e-8)
            << shape->kind_name();
      }
      ASSERT_FALSE(cast_ray(*shape, frame, from, way, 0.999 * hit->distance - 1e-12).has_value());
    }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
}

}  // namespace
}  // namespace tw::test
