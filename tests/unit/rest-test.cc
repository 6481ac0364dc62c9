// Rest without a world: books of stillness, and when a group rests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/rest/rest.h"

#include <gtest/gtest.h>

#include <cmath>

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
  // A callback that leaves the cube this velocity, a moment after its last check.
  void push(const Vec3& v) {
    const double when = tail(cube).key.time + 1e-4;
    tail(cube).group->arc->extend(when);
    regroup({when, 0, KeyKind::callback, 7}, Cause::callback, {cube},
            [&](Successor& successor) { successor.data.v = successor.point.v = v; });
  }
};

// 2 sqrt(radius / g) of a cube of 0.1 m.
const double watch = 2 * std::sqrt(0.05 * std::sqrt(3.0) / 9.81);

TEST(Rest, a_cube_that_settles_rests_after_the_watch) {
  // too fast for one that was placed touching, whose contacts would be loaded
  CubeOnFloor small({0, 0, -0.01});
  const double rested = small.run(5);
  EXPECT_TRUE(small.group_of(small.cube).at_rest);
  EXPECT_GE(rested, watch);
  EXPECT_LT(rested, 2 * watch);
  // where the hardening spring carries it: d (1 + (d / 2 d0)^2) = d0 with d0 = 2.5e-4 of the size
  const double depth = 0.84773 * 2.5e-5;
  EXPECT_NEAR(small.tail(small.cube).x.z(), 0.05 - depth, 1e-3 * depth);
  EXPECT_EQ(small.tail(small.cube).v, Vec3(Vec3::Zero()));
  EXPECT_EQ(small.group_of(small.cube).next_check(), never);
}

TEST(Rest, a_cube_that_slides_does_not_rest) {
  CubeOnFloor small({2, 0, 0});
  small.run(0.3);
  EXPECT_FALSE(small.group_of(small.cube).at_rest);
  EXPECT_EQ(small.group_of(small.cube).stillness.front().since, never);
}

TEST(Rest, a_book_begins_where_the_body_is_slow_and_ends_where_it_is_fast) {
  CubeOnFloor small(Vec3::Zero());
  small.run(0.1);
  const Stillness book = small.group_of(small.cube).stillness.front();
  ASSERT_LT(book.since, never);
  EXPECT_LE(book.since, small.tail(small.cube).key.time);
  EXPECT_NEAR((book.x - small.tail(small.cube).x).norm(), 0, 1e-4);

  small.push({1, 0, 0});
  EXPECT_EQ(small.group_of(small.cube).stillness.front().since, never);
}

TEST(Rest, what_a_callback_changed_is_watched_anew) {
  CubeOnFloor small(Vec3::Zero());
  small.run(0.1);
  ASSERT_LT(small.group_of(small.cube).stillness.front().since, 0.1);
  small.push(Vec3::Zero());
  EXPECT_EQ(small.group_of(small.cube).stillness.front().since, small.tail(small.cube).key.time);
}

// ---- some of a group ----

// How many of a row's cubes rest at the next check, where all have been slow for long, but the
// first not still: its speed grew.
std::size_t resting_beside_one(int count) {
  Row row(count);
  const BodyId restless = row.cubes.front();
  while (row.tail(restless).key.time < 0.15) row.check(restless, row.cubes);
  for (const BodyId cube : row.cubes)
    row.tail(cube).group->stillness[row.tail(cube).member] = {
        0, 0.1, 1e-4, cube == restless ? 2e-4 : 1e-5, row.tail(cube).x, row.tail(cube).q};
  row.check(restless, row.cubes);
  EXPECT_FALSE(row.group_of(restless).at_rest);
  std::size_t resting = 0;
  for (const BodyId cube : row.cubes) resting += row.group_of(cube).at_rest;
  return resting;
}

TEST(Rest, of_a_large_group_those_that_can_rest_though_one_does_not) {
  EXPECT_EQ(resting_beside_one(12), 11u);
}

TEST(Rest, a_few_are_not_worth_a_border) { EXPECT_EQ(resting_beside_one(8), 0u); }

TEST(Rest, what_touches_a_fast_one_stays_awake) {
  Row row(12);
  const BodyId fast = row.cubes.front();
  while (row.tail(fast).key.time < 0.15) row.check(fast, row.cubes);
  for (const BodyId cube : row.cubes)
    row.tail(cube).group->stillness[row.tail(cube).member] = {
        0, 0.1, 1e-4, 1e-5, row.tail(cube).x, row.tail(cube).q};
  const double when = row.tail(fast).key.time + 1e-4;
  row.tail(fast).group->arc->extend(when);
  row.regroup({when, 0, KeyKind::callback, 7}, Cause::callback, {fast}, [](Successor& successor) {
    successor.data.v = successor.point.v = {0, 0.5, 0};
  });
  row.check(row.cubes.back(), row.cubes);
  EXPECT_FALSE(row.group_of(row.cubes[0]).at_rest);
  EXPECT_FALSE(row.group_of(row.cubes[1]).at_rest);
  EXPECT_TRUE(row.group_of(row.cubes[11]).at_rest);
}

// ---- the rule for one member, by books made by hand ----

struct Book : CubeOnFloor {
  Stillness book;

  // Of a cube that stands since time 0 and rests at its next check, but for what `book` says.
  Book() : CubeOnFloor(Vec3::Zero()) {
    run(0.15);
    book = {0, watch, 1e-4, 1e-5, tail(cube).x, tail(cube).q};
  }
  bool rests() {
    tail(cube).group->stillness.front() = book;
    check(cube, {cube});
    if (group_of(cube).at_rest) return true;
    // once more where it is not yet old enough
    if (tail(cube).key.time >= watch) return false;
    return rests();
  }
};

TEST(Rest, what_settles_or_trembles_in_its_place_is_still) {
  Book settles, trembles;
  EXPECT_TRUE(settles.rests());
  trembles.book.late_peak = 1.05e-4;
  EXPECT_TRUE(trembles.rests());
}

TEST(Rest, what_gets_faster_is_not_still) {
  Book tips;
  tips.book.late_peak = 1.2e-4;
  EXPECT_FALSE(tips.rests());
}

TEST(Rest, what_gets_away_is_not_still) {
  Book creeps;
  creeps.book.late_peak = 1e-4;
  creeps.book.x.x() -= 0.5 * 1e-4 * watch;
  EXPECT_FALSE(creeps.rests());
  Book turns;
  turns.book.late_peak = 1e-4;
  turns.book.q = turns.book.q * Quat(Eigen::AngleAxisd(0.5 * 1e-4 * watch / 0.087, Vec3::UnitZ()));
  EXPECT_FALSE(turns.rests());
}

TEST(Rest, rounding_is_no_motion) {
  Book rounds;
  rounds.book = {
      0, watch, 1e-9, 1e-8, rounds.tail(rounds.cube).x + Vec3(1e-7, 0, 0), rounds.book.q};
  EXPECT_TRUE(rounds.rests());
}

}  // namespace
}  // namespace tw::test
