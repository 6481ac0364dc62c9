// Moving and standing boxes against all pairs, while the moving ones creep within their zones and
// leave them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/broad/broad-phase.h"

#include <gtest/gtest.h>

#include <set>

#include "base/random.h"

namespace tw::test {
namespace {

Vec3 random_point(Random& random, double size) {
  Vec3 point;
  for (int i = 0; i < 3; ++i) point[i] = random.real(-size, size);
  return point;
}

Aabb around(const Vec3& center, const Vec3& half) {
  return {center - half.cwiseAbs(), center + half.cwiseAbs()};
}

struct Boxes {
  BroadPhase phase;
  std::vector<Aabb> boxes;

  void place(std::uint32_t id, const Aabb& box, bool stands) {
    if (id >= boxes.size()) boxes.resize(id + 1);
    boxes[id] = box;
    phase.place(id, box, stands);
  }
  // In a box that need not lie in the zone of `id`.
  void expect_standing_in(const Aabb& box, std::uint32_t id, std::uint32_t first_standing) const {
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t other = first_standing; other < boxes.size(); ++other)
      if (box.overlaps(boxes[other])) expected.insert(other);
    phase.standing_in(box, id,
                      [&](std::uint32_t other) { EXPECT_TRUE(found.insert(other).second); });
    ASSERT_EQ(found, expected) << "around box " << id;
  }
  void expect_all_pairs(std::uint32_t first_standing) const {
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
      std::set<std::uint32_t> expected, found, standing, found_standing;
      for (std::uint32_t other = 0; other < boxes.size(); ++other) {
        if (other == id || !boxes[id].overlaps(boxes[other])) continue;
        expected.insert(other);
        if (other >= first_standing) standing.insert(other);
      }
      phase.overlapping(id, [&](std::uint32_t other) { EXPECT_TRUE(found.insert(other).second); });
      ASSERT_EQ(found, expected) << "box " << id;
      if (id >= first_standing) continue;
      phase.standing_in(boxes[id], id, [&](std::uint32_t other) { found_standing.insert(other); });
      ASSERT_EQ(found_standing, standing) << "box " << id;
      expect_standing_in(around(boxes[id].center(), 3 * boxes[id].size()), id, first_standing);
    }
  }
};

TEST(BroadPhase, finds_exactly_the_overlapping_boxes_while_some_move) {
  Random random(1);
  Boxes all;
  constexpr std::uint32_t moving = 40, count = 120;
  for (std::uint32_t id = moving; id < count; ++id)
    all.place(id, around(random_point(random, 5), random_point(random, 1)), true);
  for (std::uint32_t id = 0; id < moving; ++id)
    all.place(id, around(random_point(random, 5), random_point(random, 0.5)), false);
  for (int round = 0; round < 40; ++round) {
    for (std::uint32_t id = 0; id < moving; ++id) {
      const Vec3 half = 0.5 * all.boxes[id].size(),
                 step = random_point(random, round % 8 == 0 ? 2 : 0.1);
      all.place(id, around(all.boxes[id].center() + step, half), false);
    }
    // the ground is changed between runs
    if (round % 10 == 9)
      all.place(moving + 7, around(random_point(random, 5), random_point(random, 2)), true);
    all.expect_all_pairs(moving);
    ASSERT_TRUE(all.phase.consistent());
  }
  EXPECT_EQ(all.phase.size(), count);
}

TEST(BroadPhase, a_query_within_one_of_the_same_body_does_without_the_zone) {
  BroadPhase phase;
  phase.place(0, around(Vec3::Zero(), {1, 1, 1}), false);
  for (std::uint32_t id = 1; id < 9; ++id)
    phase.place(id, around(Vec3(0.2 * id, 0, 0), {0.1, 0.1, 0.1}), true);
  int outer = 0;
  phase.overlapping(0, [&](std::uint32_t) {
    ++outer;
    std::set<std::uint32_t> inner;
    const Aabb box = around(Vec3(0.4, 0, 0), {0.01, 0.01, 0.01});
    phase.standing_in(box, 0, [&](std::uint32_t other) { inner.insert(other); });
    EXPECT_EQ(inner, std::set<std::uint32_t>{2});
  });
  EXPECT_EQ(outer, 5);
}

}  // namespace
}  // namespace tw::test
