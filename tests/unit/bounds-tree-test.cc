// Bounds of runs of motions, added up by blocks and one by one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/bounds-tree.h"

#include <gtest/gtest.h>

#include "support/scene.h"

namespace tw::test {
namespace {

MotionBounds random_bounds(Random& random) {
  MotionBounds bounds;
  bounds.path.add(random_vector(random, 1));
  bounds.path.add(random_vector(random, 1));
  bounds.acceleration.add(random_vector(random, 1));
  bounds.speed = random.real();
  bounds.turn = random.real();
  bounds.turn_change = random.real();
  bounds.valid_until = random.real();
  return bounds;
}

void expect_same(const MotionBounds& a, const MotionBounds& b) {
  EXPECT_EQ(a.path.lo, b.path.lo);
  EXPECT_EQ(a.path.hi, b.path.hi);
  EXPECT_EQ(a.acceleration.lo, b.acceleration.lo);
  EXPECT_EQ(a.acceleration.hi, b.acceleration.hi);
  EXPECT_EQ(a.speed, b.speed);
  EXPECT_EQ(a.turn, b.turn);
  EXPECT_EQ(a.turn_change, b.turn_change);
  EXPECT_EQ(a.valid_until, b.valid_until);
}

// 5000: three levels and a bit.
TEST(BoundsTree, any_run_is_the_sum_of_its_motions) {
  Random random(7);
  BoundsTree tree;
  std::vector<MotionBounds> all;
  EXPECT_EQ(tree.size(), 0u);
  for (int i = 0; i < 5000; ++i) {
    all.push_back(random_bounds(random));
    tree.append(all.back());
  }
  EXPECT_EQ(tree.size(), 5000u);
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t length = trial < 100 ? 40 : 5001;
    const std::size_t first = random.below(5000);
    const std::size_t last = std::min<std::size_t>(5000, first + random.below(length));
    MotionBounds sum, expected;
    tree.add(first, last, sum);
    for (std::size_t i = first; i < last; ++i) expected.add(all[i]);
    expect_same(sum, expected);
  }
  MotionBounds whole, expected;
  tree.add(0, 5000, whole);
  for (const MotionBounds& one : all) expected.add(one);
  expect_same(whole, expected);
}

}  // namespace
}  // namespace tw::test
