// Cutting a face down to what lies over another one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/manifold/face-contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/shape.h"

namespace tw::test {
namespace {

// What a cube shows of the top of another one of the same size, that it stands on, turned about the
// vertical and moved aside.
std::vector<FacePoint> top_of_cube(double turn, const Vec3& aside, double tilt = 0) {
  const ShapePtr shape = make_box({1, 1, 1});
  const Polyhedron& cube = *shape->part(0).core;
  const auto face_towards = [&](const Vec3& direction) {
    for (int i = 0; i < static_cast<int>(cube.faces().size()); ++i)
      if (cube.face(i).normal.dot(direction) > 0.9) return i;
    return -1;
  };
  const Frame upper(
      Pose{Vec3(0, 0, 1) + aside, rotation_by(Vec3(0, tilt, 0)) * rotation_by(Vec3(0, 0, turn))});
  std::vector<FacePoint> points;
  std::vector<FacePoint> higher;
  face_contact(cube, face_towards(Vec3::UnitZ()), cube, upper, face_towards(-Vec3::UnitZ()), 1e-2,
               8, points, higher);
  return points;
}

// Both ends of the first edge lie beyond the side, one of them within the slack: the line of the
// edge crosses the side's far beyond its end.
TEST(FaceContact, an_edge_along_a_side_is_not_cut_beyond_its_ends) {
  Polyhedron::Side side;
  side.inward = Vec3::UnitX();
  side.offset = 0;
  constexpr double slack = 1e-12;
  std::vector<ClipCorner> polygon = {{{-0.8 * slack, 0, 0}, 0, 0},
                                     {{-1.1 * slack, 1, 0}, 0, 1},
                                     {{-1, 1, 0}, 0, 2},
                                     {{-1, 0, 0}, 0, 3}};
  clip_by_side(polygon, side, 0, slack);
  ASSERT_FALSE(polygon.empty());
  for (const ClipCorner& corner : polygon) {
    EXPECT_GE(corner.point.y(), 0);
    EXPECT_LE(corner.point.y(), 1);
  }
}

// A hair's turn lets the sides of equal outlines cross in their middles, or not, as rounding has
// it: what is seen of that would come and go.
TEST(FaceContact, a_hairs_turn_adds_no_points) {
  for (const double turn : {0.0, 1e-9, -1e-9, 1e-5, -1e-5, 1e-3, -1e-3})
    for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(1e-4, -2e-4, 0), Vec3(-3e-9, 1e-9, 0)}) {
      const std::vector<FacePoint> points = top_of_cube(turn, aside);
      ASSERT_EQ(points.size(), 4u) << turn << " " << aside.transpose();
      for (const FacePoint& p : points) {
        EXPECT_NEAR(std::abs(p.point.x()), 0.5, 2e-3);
        EXPECT_NEAR(std::abs(p.point.y()), 0.5, 2e-3);
      }
    }
  EXPECT_EQ(top_of_cube(0.1, Vec3::Zero()).size(), 8u);
}

// What is straight to the eye but deeper than its neighbours stays.
TEST(FaceContact, the_deepest_corner_stays) {
  for (const double turn : {1e-3, 1e-2})
    for (const double tilt : {1e-3, 0.03}) {
      const std::vector<FacePoint> points = top_of_cube(turn, Vec3(0, 0, -1e-3), tilt);
      double deepest = 1;
      for (const FacePoint& p : points) deepest = std::min(deepest, p.gap);
      EXPECT_NEAR(deepest, -1e-3 + 0.5 * (1 - std::cos(tilt) - std::sin(tilt)),
                  1e-5 + 0.5 * turn * tilt)
          << turn << " " << tilt;
    }
}

}  // namespace
}  // namespace tw::test
