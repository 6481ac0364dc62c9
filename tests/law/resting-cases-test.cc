// Slide, creep and stack against their closed forms.
//
// All are placed touching: their contacts are loaded from the start (placed-touching-test.cc).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "support/case-file.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

TEST(RestingCases, box_slides_down_20_degrees_as_coulomb_says) {
  World world;
  const Case c = read_case("slide");
  fill(world, c);
  world.advance(c.duration);
  const double angle = 20 * pi / 180, g = 9.81;
  const double exact = g * (std::sin(angle) - c.friction * std::cos(angle)) * 2 * 2 / 2;
  const Vec3 moved = world.state(1).position - c.bodies[1].position;
  const Vec3 down(std::cos(angle), 0, -std::sin(angle));
  EXPECT_NEAR(moved.dot(down), exact, 1e-9);
  EXPECT_LT(moved.cross(down).norm(), 1e-9);
}

TEST(RestingCases, box_does_not_creep_down_20_degrees) {
  World world;
  const Case c = read_case("creep");
  fill(world, c);
  world.advance(1);
  const Vec3 early = world.state(1).position;
  EXPECT_LT((early - c.bodies[1].position).norm(), 1e-9);
  world.advance(c.duration);
  EXPECT_EQ((world.state(1).position - early).norm(), 0) << "not at rest";
}

TEST(RestingCases, stack_of_ten_stands_still) {
  World world;
  const Case c = read_case("stack");
  fill(world, c);
  world.advance(1);
  std::vector<Vec3> early;
  for (BodyId id = 1; id <= 10; ++id) early.push_back(world.state(id).position);
  world.advance(c.duration);
  for (BodyId id = 1; id <= 10; ++id) {
    const Vec3 now = world.state(id).position;
    EXPECT_LT((now - early[id - 1]).norm(), 1e-6) << id;
    EXPECT_LT(now.head<2>().norm(), 1e-9) << id;
    const double below = id == 1 ? 0 : world.state(id - 1).position.z() + 0.5;
    const double depth = below - (now.z() - 0.5);
    EXPECT_NEAR(depth, 0, 1e-9) << id;
  }
}

// What starts the group anew keeps the friction's stretch: a box held by it must not slip a little
// each time.
TEST(RestingCases, taps_do_not_make_a_box_creep) {
  World world;
  const Case c = read_case("creep");
  fill(world, c);
  world.advance(1);
  const Vec3 early = world.state(1).position;
  for (int i = 1; i <= 40; ++i) {
    world.edit(1, [&](StateView& box) { box.set_applied_force({0, i % 2 ? 1.0 : -1.0, 0}); });
    world.advance(1 + 0.05 * i);
  }
  EXPECT_LT((world.state(1).position - early).norm(), 1e-6);
}

// A settled heap costs nothing: no events at all.
TEST(RestingCases, what_rests_has_no_events) {
  World world;
  fill(world, read_case("stack"));
  world.advance(5);
  const std::int64_t events = count_of(world.statistics(), "events");
  world.advance(1000);
  EXPECT_EQ(count_of(world.statistics(), "events"), events);
  EXPECT_EQ(world.time(), 1000);
}

// 0.1 degree either way of the friction angle, atan(0.5).
TEST(RestingCases, box_near_the_friction_angle_stays_or_slides) {
  for (const double off : {-0.1, 0.1}) {
    World world;
    const double angle = std::atan(0.5) + off * pi / 180;
    set_contact_for_all(world, 0, 0.5);
    const Vec3 normal(std::sin(angle), 0, std::cos(angle)),
        down(std::cos(angle), 0, -std::sin(angle));
    add_wall(world, normal, 0);
    BodyDef box = body_of(make_box({1, 1, 0.5}), 0.25 * normal, Vec3::Zero());
    box.orientation = rotation_by(Vec3(0, angle, 0));
    const BodyId id = world.add_body(box);
    world.advance(4);
    const double moved = (world.state(id).position - box.position).dot(down);
    const double exact = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)) * 16 / 2;
    // while the weight comes on it may slip a little
    if (off < 0)
      EXPECT_LT(std::abs(moved), 2e-3);
    else
      EXPECT_NEAR(moved, exact, 0.05 * exact);
  }
}

// Whatever the accuracy: looser steps were no fewer, and lost a fifth of the way at 1e-2.
TEST(RestingCases, box_slides_as_far_at_any_accuracy) {
  const double angle = 20 * pi / 180, mu = 0.3, half = 0.25;
  for (const double accuracy : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    World world;
    world.set_accuracy(accuracy);
    set_contact_for_all(world, 0, mu);
    const Vec3 normal(std::sin(angle), 0, std::cos(angle)),
        down(std::cos(angle), 0, -std::sin(angle));
    add_wall(world, normal, 0);
    BodyDef box = body_of(make_box(Vec3::Constant(2 * half)), half * normal, Vec3::Zero());
    box.orientation = rotation_by(Vec3(0, angle, 0));
    const BodyId id = world.add_body(box);
    world.advance(2);
    const double moved = (world.state(id).position - box.position).dot(down);
    const double exact = 9.81 * (std::sin(angle) - mu * std::cos(angle)) * 2 * 2 / 2;
    EXPECT_NEAR(moved, exact, accuracy > 1e-6 ? 1e-3 * exact : 1e-4 * exact) << accuracy;
  }
}

// A box that leans back a little beyond its balance tips over in the end: rest must not freeze it.
TEST(RestingCases, slowly_tipping_tower_is_not_frozen) {
  for (const double past : {-1e-3, 1e-3}) {
    World world;
    set_contact_for_all(world, 0, 0.8);
    add_wall(world, Vec3::UnitZ(), 0);
    // a slab on its edge, the centre over the edge but for `past` radians
    const double half_width = 0.1, half_height = 0.5;
    const double balance = std::atan2(half_width, half_height);
    BodyDef slab =
        body_of(make_box({2 * half_width, 0.4, 2 * half_height}), Vec3::Zero(), Vec3::Zero());
    slab.orientation = rotation_by(Vec3(0, balance + past, 0));
    const Vec3 edge = slab.orientation * Vec3(half_width, 0, -half_height);
    slab.position = Vec3(0, 0, -edge.z());
    const BodyId id = world.add_body(slab);
    world.advance(10);
    const Vec3 up = world.state(id).orientation * Vec3::UnitZ();
    if (past > 0)
      EXPECT_LT(up.z(), 0.05) << "did not tip over";
    else
      EXPECT_GT(up.z(), 0.999) << "did not fall back";
  }
}

}  // namespace
}  // namespace tw::test
