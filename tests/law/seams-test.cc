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

// Tiles a pitch of 0.2 m long, but for a slot between any two, which lie still or move.
void add_slotted(World& world, int count, double slot, double from, double speed) {
  constexpr double pitch = 0.2;
  for (int i = 0; i < count; ++i) {
    BodyDef tile;
    tile.shape = make_box({pitch - slot, 2, 0.05});
    tile.position = {from + pitch * i, 0, -0.025};
    tile.fixed = speed == 0;
    if (speed != 0)
      tile.motion = make_keyframes(
          {{0, tile.position, {}}, {4, tile.position + Vec3(4 * speed, 0, 0), {}}}, true);
    world.add_body(tile);
  }
}

// What slides lies a hair below the edges that it comes to: they are no walls.
TEST(Seams, slots_are_slid_over) {
  for (const double slot : {0.0, 1e-5, 1e-3, 1e-2})
    for (const double speed : {0.1, 1.2, 2.5}) {
      World world;
      set_contact_for_all(world, 0, 0);
      add_slotted(world, 40, slot, -1, 0);
      const BodyId crate =
          world.add_body(body_of(make_box({0.2, 0.15, 0.3}), {0.013, 0, 0.15}, {speed, 0, 0}));
      world.advance(2);
      const BodyState state = world.state(crate);
      EXPECT_NEAR(state.velocity.x(), speed, 1e-9) << slot;
      EXPECT_NEAR(state.position.z(), 0.15, 2e-4) << slot << " " << speed;
    }
}

// A belt of slats takes along what a stop holds back by friction alone.
TEST(Seams, slats_of_a_belt_do_not_catch) {
  for (const double slot : {0.0, 1e-3}) {
    World world;
    constexpr double friction = 0.6, speed = 1.2;
    set_contact_for_all(world, 0, friction);
    add_slotted(world, 34, slot, -6, speed);
    BodyDef stop;
    stop.shape = make_box({0.1, 2, 0.5});
    stop.position = {1.2, 0, 0.251};
    stop.fixed = true;
    world.add_body(stop);
    const BodyId crate =
        world.add_body(body_of(make_box({0.2, 0.15, 0.32}), {0.6, 0, 0.16}, Vec3::Zero()));
    world.advance(4);
    EXPECT_GT(world.state(crate).position.z(), 0.15) << slot;
    const double force = friction * world.body(crate).mass * 9.81;
    const double work = number_of(world.statistics(), "kinematic_work");
    EXPECT_LT(work, 4 * force * speed) << slot;
    EXPECT_GT(work, 0.8 * 4 * force * speed) << slot << ": it slides when it has come to the stop";
  }
}

// How deep what falls at 3 m/s gets in fixed bodies, m.
double depth_of(const ShapePtr& falling, const Vec3& from, const std::vector<ShapePtr>& fixed) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  for (const ShapePtr& shape : fixed) {
    BodyDef def;
    def.shape = shape;
    def.fixed = true;
    world.add_body(def);
  }
  world.add_body(body_of(falling, from, {0, 0, -3}));
  StabilityOutcome outcome;
  for (int i = 1; i <= 150; ++i) {
    world.advance(0.001 * i);
    measure_depths(world, outcome);
  }
  return outcome.deepest;
}

// Along x, from `along` on its axis, turned about z.
ShapePtr lying(const ShapePtr& shape, double about_z, double along) {
  Pose pose;
  pose.q = Quat(Eigen::AngleAxisd(about_z, Vec3::UnitZ())) *
           Quat(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitY()));
  pose.p = pose.q * Vec3(0, 0, along);
  return place_shape(shape, pose);
}

// Beside the circle in which round parts meet flush, each is all but within the other.
TEST(Seams, of_round_parts_that_meet_flush_let_nothing_through) {
  constexpr double r = 0.02;
  const ShapePtr rod = lying(make_cylinder(r, 0.2), 0, 0),
                 half = lying(make_cylinder(r, 0.1), 0, 0.05), ball = make_sphere(0.01);
  const std::pair<const char*, ShapePtr> cases[] = {
      {"a bead on a rod", make_union({rod, make_sphere(r)})},
      {"a rounded end", make_union({half, make_sphere(r)})},
      {"an egg on a rod", make_union({rod, make_ellipsoid({0.03, r, r})})},
      {"a dish at an end", make_union({half, make_ellipsoid({0.2 * r, r, r})})},
      {"a knee",
       make_union({lying(make_capsule(r, 0.1), 0, 0.05), lying(make_capsule(r, 0.1), 2.6, 0.05)})}};
  for (const auto& [name, shape] : cases)
    for (const double off : {0., 1e-6, 5e-6, 1e-5, 2e-5, 5e-5, 7e-5, 1e-4, 2e-4, 5e-4, 1e-3})
      for (const double x : {off, -off})
        EXPECT_LT(depth_of(ball, {x, 0, r + 0.013}, {shape}), 1e-3 * r) << name << ", " << x;
}

// Under the ends of two rods, where a tip is deeper in either than it is beside its end.
TEST(Seams, of_rods_end_to_end_hold_corners_and_edges) {
  constexpr double r = 0.1;
  const ShapePtr one = lying(make_cylinder(r, 0.2), 0, -0.1),
                 other = lying(make_cylinder(r, 0.2), 0, 0.1);
  const Quat askew(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  Pose on_corner, on_edge;
  on_corner.q =
      askew * Quat(Eigen::AngleAxisd(std::acos(1 / std::sqrt(3)), Vec3(-1, 1, 0).normalized()));
  on_edge.q = Quat(Eigen::AngleAxisd(0.25 * pi, Vec3::UnitY()));
  for (const auto& [pose, low] :
       {std::pair{on_corner, 0.01 * std::sqrt(3)}, std::pair{on_edge, 0.01 * std::sqrt(2)}}) {
    const ShapePtr cube = place_shape(make_box(Vec3::Constant(0.02)), pose);
    for (const double x : {0., 1e-7, -1e-6, 1e-6, 1e-5}) {
      const Vec3 from(x, 0, r + low + 0.003);
      EXPECT_LT(depth_of(cube, from, {make_union({one, other})}), 5e-5) << x;
      EXPECT_LT(depth_of(cube, from, {one, other}), 5e-5) << x;
    }
  }
}

// But a step is one.
TEST(Seams, a_step_stops_what_slides) {
  World world;
  set_contact_for_all(world, 0, 0);
  for (const double top : {0.0, 1e-3}) {
    BodyDef half;
    half.shape = make_box({4, 2, 1});
    half.position = {top > 0 ? 3.0 : -1.0, 0, top - 0.5};
    half.fixed = true;
    world.add_body(half);
  }
  const BodyId crate = world.add_body(body_of(make_box({0.2, 0.15, 0.1}), {0, 0, 0.05}, {1, 0, 0}));
  world.advance(2);
  EXPECT_LT(world.state(crate).position.x(), 0.91);
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
