// Cutting a face down to what lies over another one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/face-contact.h"

#include <gtest/gtest.h>

namespace tw::test {
namespace {

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

}  // namespace
}  // namespace tw::test
