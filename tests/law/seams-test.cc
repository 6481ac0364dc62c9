// Seams: bodies that cross the joints of a floor of many pieces move as on one.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/crossers.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

// A floor 8 m long of `tiles` boxes, and a body that crosses it at 3 m/s for a second.
BodyState cross(int tiles, bool one_union, const ShapePtr& shape, double friction,
                const Vec3& spin) {
  World world;
  set_contact_for_all(world, 0.2, friction);
  const double length = 8.0 / tiles;
  std::vector<ShapePtr> parts;
  for (int i = 0; i < tiles; ++i) {
    BodyDef tile;
    tile.shape = make_box({length, 4, 1});
    tile.position = Vec3(-0.5 + length * (i + 0.5), 0, -0.5);
    tile.fixed = true;
    Pose pose;
    pose.p = tile.position;
    parts.push_back(place_shape(tile.shape, pose));
    if (!one_union) world.add_body(tile);
  }
  if (one_union) {
    BodyDef floor;
    floor.shape = make_union(parts);
    floor.fixed = true;
    world.add_body(floor);
  }
  // let down: what is placed touching and rolls starts loaded, and loses that at the first seam
  const BodyId id = world.add_body(body_of(shape, {0, 0, 0.1 + 1e-5}, {3, 0, 0}, spin));
  world.advance(1);
  return world.state(id);
}

TEST(Seams, forty_are_crossed_as_none) {
  for (const Crosser& c : crossers()) {
    const BodyState plain = cross(1, false, c.shape, c.friction, c.spin);
    const BodyState seamed = cross(40, false, c.shape, c.friction, c.spin);
    EXPECT_LT((seamed.position - plain.position).norm(), 1e-5) << c.name;
    EXPECT_LT((seamed.velocity - plain.velocity).norm(), 1e-4) << c.name;
  }
}

TEST(Seams, of_a_union_are_crossed_as_none) {
  for (const Crosser& c : crossers()) {
    const BodyState plain = cross(1, false, c.shape, c.friction, c.spin);
    const BodyState seamed = cross(40, true, c.shape, c.friction, c.spin);
    EXPECT_LT((seamed.position - plain.position).norm(), 1e-5) << c.name;
  }
}

// A stone that gravity of (-4, 0, -9.81) m/s^2 pushes across the ground into a wall, which begins
// at the ground's surface: the deepest overlap, m.
double depth_at_a_wall(std::uint64_t seed) {
  World world;
  set_contact_for_all(world, 0.2, 0.3);
  world.set_gravity(Vec3(-4, 0, -9.81));
  const auto add_fixed = [&](const Vec3& edges, const Vec3& at) {
    BodyDef def = body_of(make_box(edges), at, Vec3::Zero());
    def.fixed = true;
    world.add_body(def);
  };
  add_fixed({6, 6, 1}, {0, 0, -0.5});
  add_fixed({0.5, 3, 3}, {-1.25, 0, 1.5});
  Random random(seed);
  BodyDef stone = body_of(random_heap_body(random, false, 0.4).shape, {-0.5, 0, 0.4}, Vec3::Zero());
  stone.orientation = random_attitude(random);
  stone.density = 2600;
  world.add_body(stone);
  StabilityOutcome outcome;
  for (int i = 1; i <= 140; ++i) {
    world.advance(0.005 * i);
    measure_depths(world, outcome);
  }
  return outcome.deepest;
}

// Corners that lie in the ground are below the wall's lower edge, which the ground buries.
TEST(Seams, a_wall_that_stands_on_the_ground_holds_corners_that_lie_in_the_ground) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) EXPECT_LT(depth_at_a_wall(seed), 5e-4) << seed;
  // the same in a heap, which gained a tenth of its energy as one came up again
  const StabilityOutcome heap = StabilityRun(heap_scene(30, 18, true, 0.2, 1.05), 20).run();
  EXPECT_EQ(heap.error, "");
  EXPECT_LT(heap.rise_share(), 1e-4);
}

}  // namespace
}  // namespace tw::test
