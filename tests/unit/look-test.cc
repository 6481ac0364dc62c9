// Looks that remember the last one, against queries that know of nothing.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/look/look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/random.h"
#include "collision/distance/separation.h"

namespace tw {
namespace {

Vec3 any(Random& random, double size) {
  return {random.real(-size, size), random.real(-size, size), random.real(-size, size)};
}

Quat any_attitude(Random& random) {
  Quat q(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
  return q.normalized();
}

ShapePtr any_rock(Random& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i) points.push_back(0.25 * any(random, 1).normalized());
  return make_hull(points);
}

// Where the points of a look are now: by how much the deepest is deeper than `distance`.
double deepest(const PartLook& look, const Frame& a, const Frame& b) {
  double least = 1e300;
  for (int i = 0; i < look.count; ++i) {
    const LookPoint& p = look.points[static_cast<std::size_t>(i)];
    const Frame &of = p.reference_is_a ? a : b, &other = p.reference_is_a ? b : a;
    const double gap = (of.R * p.normal).dot(other * p.core - of.p) - p.offset - p.radius;
    EXPECT_NEAR(gap, p.gap, 1e-12);
    EXPECT_NEAR(p.normal.norm(), 1, 1e-12);
    least = std::min(least, gap);
  }
  return least;
}

// Two bodies that drift past each other; each look is held against the distance between them.
void drift(const ShapePtr& first, const ShapePtr& second, Random& random, double size) {
  PairMemory memory;
  Pose a{Vec3::Zero(), any_attitude(random)};
  Pose b{1.2 * size * any(random, 1).normalized(), any_attitude(random)};
  const Vec3 v = -b.p + any(random, 0.3 * size), w = any(random, 1), turn = any(random, 0.5);
  constexpr int steps = 40;
  const double reach = 0.02 * size;
  for (int i = 0; i < steps; ++i) {
    b.p += v / steps;
    b.q = rotation_by(w / steps) * b.q;
    a.q = rotation_by(turn / steps) * a.q;
    const Frame frame_a(a), frame_b(b);
    PartLook look;
    look_at(first->part(0), frame_a, second->part(0), frame_b, reach, ReferenceChoice::larger,
            memory, look);
    const double distance = signed_distance(*first, frame_a, *second, frame_b);
    // deep in each other one face is taken for nearest as long as it was
    if (distance < -0.05 * size) return;
    if (distance > reach) {
      EXPECT_LE(look.distance, distance + 1e-9);
      EXPECT_TRUE(look.distance > reach || look.count > 0);
      if (look.count == 0 && look.axis != Vec3::Zero()) {
        EXPECT_NEAR(look.axis.norm(), 1, 1e-9);
      }
      continue;
    }
    ASSERT_GT(look.count, 0);
    EXPECT_NEAR(look.distance, distance, 0.01 * std::abs(distance) + 3e-4 * size);
    EXPECT_NEAR(deepest(look, frame_a, frame_b), distance, 0.01 * std::abs(distance) + 3e-4 * size);
  }
}

TEST(Look, finds_the_distance_of_drifting_rocks) {
  Random random(1);
  for (int i = 0; i < 300; ++i) drift(any_rock(random), any_rock(random), random, 0.5);
}

TEST(Look, finds_the_distance_of_drifting_boxes_and_others) {
  Random random(2);
  const ShapePtr shapes[] = {make_box(Vec3(0.2, 0.4, 0.3)), make_sphere(0.2),
                             make_cylinder(0.15, 0.4), make_capsule(0.1, 0.3),
                             make_ellipsoid(Vec3(0.1, 0.2, 0.25))};
  for (int i = 0; i < 300; ++i)
    drift(shapes[random.below(5)], shapes[random.below(5)], random, 0.45);
}

TEST(Look, at_boxes_that_lie_on_each_other_names_the_corners_and_keeps_their_names) {
  const ShapePtr below = make_box(Vec3(1, 1, 0.2)), above = make_box(Vec3(0.3, 0.3, 0.3));
  PairMemory memory;
  std::vector<std::uint64_t> names;
  for (int i = 0; i < 5; ++i) {
    const Frame a,
        b(rotation_by(Vec3(0, 0, 0.02 * i)).toRotationMatrix(), Vec3(0.02 * i, 0, 0.25 - 1e-4));
    PartLook look;
    look_at(below->part(0), a, above->part(0), b, 1e-3, ReferenceChoice::larger, memory, look);
    ASSERT_EQ(look.count, 4);
    EXPECT_TRUE(look.on_face);
    EXPECT_NEAR(look.room, 0.3, 0.1);
    std::vector<std::uint64_t> now;
    for (int k = 0; k < 4; ++k) now.push_back(look.points[static_cast<std::size_t>(k)].feature);
    std::sort(now.begin(), now.end());
    if (i == 0) names = now;
    EXPECT_EQ(now, names);
    EXPECT_NEAR(deepest(look, a, b), -1e-4, 1e-12);
  }
}

}  // namespace
}  // namespace tw
