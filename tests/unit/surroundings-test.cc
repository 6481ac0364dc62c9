// The ground around a body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/surroundings.h"

#include <gtest/gtest.h>

#include "support/small-scene.h"

namespace tw::test {
namespace {

// What no box holds is near where the half-space is, like what a box holds.
TEST(Surroundings, half_spaces_are_ground_where_the_body_comes_near_them) {
  SmallScene small;
  const BodyId floor = small.add_floor();
  const BodyId cube = small.add_cube(1, {0, 0, 5});
  const auto ground_at = [&](double z) {
    return small.surroundings
        .ground_around(small.scene.body(cube), {Frame(Mat3::Identity(), Vec3(0, 0, z))})
        .bodies;
  };
  EXPECT_EQ(ground_at(0.5), std::vector<BodyId>{floor});
  EXPECT_EQ(ground_at(0.55), std::vector<BodyId>{floor});
  EXPECT_EQ(ground_at(-3), std::vector<BodyId>{floor});
  EXPECT_TRUE(ground_at(5).empty());
}

}  // namespace
}  // namespace tw::test
