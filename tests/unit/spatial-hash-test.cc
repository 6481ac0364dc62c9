// The spatial hash against all pairs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/broad/spatial-hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/random.h"

namespace tw::test {
namespace {

// Boxes of very different sizes, and corners on the cells' borders now and then.
Aabb random_box(Random& random) {
  const double size = std::pow(2.0, random.real(-6, 4));
  Vec3 center, half;
  for (int i = 0; i < 3; ++i) {
    center[i] = random.real(-20, 20);
    half[i] = size * random.real(0, 1);
    if (random.below(4) == 0) center[i] = std::round(center[i]);
    if (random.below(4) == 0) half[i] = std::round(half[i]);
  }
  return {center - half, center + half};
}

std::set<std::uint32_t> found_by(SpatialHash& hash, std::uint32_t id) {
  std::set<std::uint32_t> found;
  hash.overlapping(id, [&](std::uint32_t other) {
    EXPECT_TRUE(found.insert(other).second) << other << " twice";
  });
  return found;
}

void expect_all_pairs(SpatialHash& hash, const std::map<std::uint32_t, Aabb>& boxes) {
  for (const auto& [id, box] : boxes) {
    std::set<std::uint32_t> expected;
    for (const auto& [other, other_box] : boxes)
      if (other != id && box.overlaps(other_box)) expected.insert(other);
    ASSERT_EQ(found_by(hash, id), expected) << "box " << id;
  }
}

TEST(SpatialHash, finds_exactly_the_overlapping_boxes_while_they_move) {
  Random random(1);
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  for (int round = 0; round < 30; ++round) {
    for (int i = 0; i < 60; ++i) {
      const auto id = static_cast<std::uint32_t>(random.below(150));
      if (boxes.contains(id) && random.below(5) == 0) {
        hash.remove(id);
        boxes.erase(id);
      } else {
        boxes[id] = random_box(random);
        hash.place(id, boxes[id]);
      }
    }
    ASSERT_TRUE(hash.consistent());
    ASSERT_EQ(hash.size(), boxes.size());
    expect_all_pairs(hash, boxes);
  }
}

TEST(SpatialHash, boxes_that_only_touch_are_found) {
  SpatialHash hash;
  hash.place(0, {Vec3(0, 0, 0), Vec3(1, 1, 1)});
  hash.place(1, {Vec3(1, 0, 0), Vec3(2, 1, 1)});
  hash.place(2, {Vec3(1, 1, 1), Vec3(1, 1, 1)});
  hash.place(3, {Vec3(std::nextafter(1.0, 2.0), 0, 0), Vec3(2, 1, 1)});
  EXPECT_EQ(found_by(hash, 0), (std::set<std::uint32_t>{1, 2}));
}

TEST(SpatialHash, boxes_of_extreme_sizes_and_places_are_found) {
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  const double scales[] = {1e-9, 1e-3, 1, 1e3, 1e9};
  std::uint32_t id = 0;
  for (const double scale : scales)
    for (const double place : {0.0, 1.0, 1e6})
      boxes[id++] = {Vec3::Constant(place - scale), Vec3::Constant(place + scale)};
  for (const auto& [k, box] : boxes) hash.place(k, box);
  EXPECT_TRUE(hash.consistent());
  expect_all_pairs(hash, boxes);
}

}  // namespace
}  // namespace tw::test
