// The spatial hash against the test of all pairs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/random.h"
#include "collision/spatial-hash.h"

namespace tw {
namespace {

Aabb box_at(const Vec3& center, const Vec3& half) {
  Aabb box;
  box.add(center - half);
  box.add(center + half);
  return box;
}

Vec3 random_vector(Random& random, double from, double to) {
  const double x = random.real(from, to), y = random.real(from, to), z = random.real(from, to);
  return {x, y, z};
}

// Each box's partners, each found once, are those the test of all pairs finds.
void expect_all_overlaps(const SpatialHash& hash, const std::map<std::uint32_t, Aabb>& boxes) {
  for (const auto& [id, box] : boxes) {
    std::multiset<std::uint32_t> found, expected;
    hash.overlapping(id, [&](std::uint32_t other) { found.insert(other); });
    for (const auto& [other, other_box] : boxes)
      if (other != id && box.overlaps(other_box)) expected.insert(other);
    EXPECT_EQ(found, expected) << "box " << id;
  }
}

TEST(SpatialHash, finds_every_overlap_once_among_boxes_of_all_sizes_that_come_move_and_go) {
  Random random(1);
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  for (int round = 0; round < 20; ++round) {
    for (int change = 0; change < 100; ++change) {
      const std::uint32_t id = static_cast<std::uint32_t>(random.below(300));
      if (random.below(5) == 0) {
        hash.remove(id);
        boxes.erase(id);
        continue;
      }
      // sizes from 1 cm to 10 m, thin boxes among them
      const Vec3 half = 0.005 * random_vector(random, 0, 3).unaryExpr([](double e) {
        return std::pow(10.0, e);
      });
      boxes[id] = box_at(random_vector(random, -8, 8), half);
      hash.place(id, boxes[id]);
    }
    ASSERT_TRUE(hash.consistent());
    ASSERT_EQ(hash.size(), boxes.size());
    expect_all_overlaps(hash, boxes);
  }
}

TEST(SpatialHash, boxes_that_only_touch_overlap) {
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  // edges that are no binary fractions, on and off the cells' faces
  for (std::uint32_t i = 0; i < 200; ++i) {
    boxes[i].lo = Vec3(0.1 * i, -0.3, 1e6);
    boxes[i].hi = Vec3(0.1 * (i + 1), 0.3, 1e6 + 0.1);
    hash.place(i, boxes[i]);
  }
  expect_all_overlaps(hash, boxes);
  int neighbours = 0;
  hash.overlapping(100, [&](std::uint32_t) { ++neighbours; });
  EXPECT_EQ(neighbours, 2);
}

TEST(SpatialHash, boxes_without_extent_and_boxes_far_out_are_found) {
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  const double places[] = {0, 1e-30, 1, 3e7, 1e20, 1e40, 1e300};
  std::uint32_t id = 0;
  for (const double place : places)
    for (const double half : {0.0, 0.5, 1e12}) {
      boxes[id] = box_at(Vec3(place, -place, 0), Vec3::Constant(half));
      hash.place(id, boxes[id]);
      ++id;
    }
  EXPECT_TRUE(hash.consistent());
  expect_all_overlaps(hash, boxes);
}

TEST(SpatialHash, a_large_box_finds_small_ones_on_the_far_side_of_the_table) {
  SpatialHash hash;
  std::map<std::uint32_t, Aabb> boxes;
  for (std::uint32_t i = 0; i < 500; ++i) {
    boxes[i] = box_at(Vec3(2.0 * i, 0, 0), Vec3::Constant(0.4));
    hash.place(i, boxes[i]);
  }
  boxes[500] = box_at(Vec3(500, 0, 0), Vec3(300, 1, 1));
  hash.place(500, boxes[500]);
  expect_all_overlaps(hash, boxes);
}

}  // namespace
}  // namespace tw
