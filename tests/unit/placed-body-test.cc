// How fast the surface of a body moves, as contacts ask for it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "dynamics/placed-body.h"

namespace tw {
namespace {

PlacedBody turning(const Body& body) {
  PoseTwist point;
  point.v = Vec3(3, 4, 0);
  point.w = Vec3(0, 0, 2);
  return PlacedBody(body, point);
}

TEST(PlacedBody, turning_counts_once) {
  Body box;
  box.radius = 0.5;
  EXPECT_DOUBLE_EQ(turning(box).surface_speed(), 5 + 2 * 0.5);
}

TEST(PlacedBody, a_ball_that_spins_in_its_place_sweeps_nothing) {
  Body ball;
  ball.radius = ball.sphere_radius = 0.5;
  EXPECT_DOUBLE_EQ(turning(ball).surface_speed(), 5);
}

// What spins about the axis along which it is long moves its surface by its girth alone.
TEST(PlacedBody, what_is_slender_turns_slowly_about_its_axis) {
  Body rod;
  rod.radius = 0.5;
  rod.slender_axis = 2;
  rod.girth = 0.01;
  EXPECT_DOUBLE_EQ(turning(rod).surface_speed(), 5 + 2 * 0.01);
  rod.slender_axis = 0;
  EXPECT_DOUBLE_EQ(turning(rod).surface_speed(), 5 + 2 * 0.5);
}

}  // namespace
}  // namespace tw
