// Rest without a world: books of stillness, and when a group rests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/rest.h"

#include <gtest/gtest.h>

#include "support/small-scene.h"

namespace tw::test {
namespace {

struct CubeOnFloor : SmallScene {
  BodyId floor = add_floor();
  BodyId cube;

  explicit CubeOnFloor(const Vec3& v, const Vec3& w = Vec3::Zero())
      : cube(add_cube(0.1, {0, 0, 0.05}, v, w)) {
    fuse(floor, cube, 0);
  }
  // Checks until it rests or `until`, s; the time of the last one.
  double run(double until) {
    while (!group_of(cube).at_rest && tail(cube).key.time < until) check(cube, {cube});
    return tail(cube).key.time;
  }
};

TEST(Rest, a_cube_that_settles_rests_after_it_was_quiet_for_a_while) {
  CubeOnFloor small(Vec3::Zero());
  const double rested = small.run(5);
  EXPECT_TRUE(small.group_of(small.cube).at_rest);
  EXPECT_FALSE(small.group_of(small.cube).asleep);
  EXPECT_GE(rested, 0.2);
  EXPECT_LT(rested, 1);
  // where the hardening spring carries it: d (1 + (d / 2 d0)^2) = d0 with d0 = 2.5e-4 of the size
  const double depth = 0.84773 * 2.5e-5;
  EXPECT_NEAR(small.tail(small.cube).x.z(), 0.05 - depth, 1e-3 * depth);
  EXPECT_EQ(small.tail(small.cube).v, Vec3(Vec3::Zero()));
  EXPECT_EQ(small.group_of(small.cube).next_check, never);
}

TEST(Rest, a_cube_that_slides_does_not_rest) {
  CubeOnFloor small({2, 0, 0});
  small.run(0.3);
  EXPECT_FALSE(small.group_of(small.cube).at_rest);
  EXPECT_EQ(small.group_of(small.cube).quiet.since, never);
}

TEST(Rest, a_book_of_stillness_begins_where_the_body_is_slow_and_ends_where_it_is_fast) {
  CubeOnFloor small(Vec3::Zero());
  small.run(0.1);
  const Stillness book = small.group_of(small.cube).stillness.front();
  ASSERT_LT(book.since, never);
  EXPECT_LE(book.since, small.tail(small.cube).key.time);
  EXPECT_NEAR((book.x - small.tail(small.cube).x).norm(), 0, 1e-4);

  // pushed by a callback: nothing is known of its stillness any more
  const Key key{small.tail(small.cube).key.time, 0, KeyKind::callback, 7};
  Key later = key;
  later.time += 1e-4;
  small.tail(small.cube).group->arc->extend(later.time);
  small.regroup(later, Cause::callback, {small.cube}, [](Successor& successor) {
    successor.data.v = successor.point.v = {1, 0, 0};
  });
  EXPECT_EQ(small.group_of(small.cube).stillness.front().since, never);
}

}  // namespace
}  // namespace tw::test
