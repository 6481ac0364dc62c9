// Soft impacts: what stays in contact becomes a contact group, soon, and comes to rest.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

BodyId add_named_ball(World& world, const std::string& name, const Vec3& position,
                      const Vec3& velocity = Vec3::Zero()) {
  BodyDef def = body_of(make_sphere(0.5), position, velocity);
  def.name = name;
  return world.add_body(def);
}

// Times of fusions.
void watch_fusions(World& world, std::vector<double>& times) {
  world.add_collision_observer([&times](const Collision& c) { times.push_back(c.time); },
                               CollisionKind::fusion);
}

TEST(SoftImpacts, ball_bounces_ever_lower_and_stays) {
  for (const double e : {0.3, 0.5, 0.8, 0.95}) {
    World world;
    std::vector<double> fusions;
    watch_fusions(world, fusions);
    set_contact_for_all(world, e, 0.3);
    add_floor(world);
    const BodyId ball = add_named_ball(world, "ball", {0, 0, 2.5});
    world.advance(100);
    // e^n v_0 falls below the fusion speed after n bounces
    const double v0 = std::sqrt(2 * 9.81 * 2), fusion = 0.07 * std::sqrt(9.81 * 1);
    const double bounces = std::ceil(std::log(fusion / v0) / std::log(e));
    EXPECT_EQ(count_of(world.statistics(), "collisions"), bounces) << e;
    ASSERT_EQ(fusions.size(), 1u) << e;
    // v_0/g to fall, then 2 e^k v_0/g a bounce
    double when = v0 / 9.81;
    for (int k = 1; k <= bounces; ++k) when += 2 * std::pow(e, k) * v0 / 9.81;
    EXPECT_NEAR(fusions[0], when, 1e-9) << e;
    EXPECT_EQ(world.state(ball).velocity.norm(), 0) << "not at rest, e " << e;
    // the law's depth under its own weight: d (1 + (d/2 d0)^2) = d0, d0 = 2.5e-4 of its size
    EXPECT_NEAR(world.state(ball).position.z(), 0.5, 2.5e-4);
  }
}

TEST(SoftImpacts, restitution_zero_fuses_at_the_second_touch) {
  World world;
  std::vector<double> fusions;
  watch_fusions(world, fusions);
  set_contact_for_all(world, 0, 0.3);
  add_floor(world);
  add_named_ball(world, "ball", {0, 0, 2.5});
  world.advance(3);
  const double fall = std::sqrt(2 * 2 / 9.81);
  ASSERT_EQ(fusions.size(), 1u);
  EXPECT_NEAR(fusions[0], fall, 1e-9);
}

TEST(SoftImpacts, bodies_that_start_at_rest_on_the_floor_fuse_at_once) {
  World world;
  std::vector<double> fusions;
  watch_fusions(world, fusions);
  set_contact_for_all(world, 0.5, 0.3);
  add_floor(world);
  add_named_ball(world, "ball", {0, 0, 0.5});
  world.add_body(body_of(make_box({1, 1, 1}), {3, 0, 0.5}, Vec3::Zero()));
  world.advance(2);
  ASSERT_EQ(fusions.size(), 2u);
  for (const double when : fusions) EXPECT_LT(when, 1e-5);
  EXPECT_EQ(count_of(world.statistics(), "collisions"), 0);
}

TEST(SoftImpacts, columns_of_balls_come_to_rest_or_fall_apart) {
  for (const int count : {2, 3, 5})
    for (const double e : {0.2, 0.5, 0.8}) {
      World world;
      set_contact_for_all(world, e, 0.3);
      add_floor(world);
      for (int i = 0; i < count; ++i)
        add_named_ball(world, "ball-" + std::to_string(i), {0, 0, 1 + 1.5 * i});
      const double before = world.total_energy();
      world.advance(10);
      EXPECT_LT(world.total_energy(), before);
      EXPECT_GT(count_of(world.statistics(), "fusions"), 0) << count << " " << e;
      EXPECT_LT(count_of(world.statistics(), "collisions"), 3000) << count << " " << e;
      for (BodyId id = 1; id < world.body_count(); ++id)
        EXPECT_GT(world.state(id).position.z(), 0.499) << count << " " << e;
    }
}

TEST(SoftImpacts, inelastic_collapse_in_free_flight_does_not_stall) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 0.05, 0);
  add_named_ball(world, "left", {-1.1, 0, 0}, {1, 0, 0});
  add_named_ball(world, "middle", {0, 0, 0}, {0, 0, 0});
  add_named_ball(world, "right", {1.1, 0, 0}, {-1, 0, 0});
  world.advance(10);
  EXPECT_LT(count_of(world.statistics(), "collisions"), 3000);
  EXPECT_NEAR(world.total_momentum().norm(), 0, 1e-9);
}

// A break shot, a cradle, and a fast ball between two walls are no soft impacts.
TEST(SoftImpacts, fast_elastic_sequences_are_not_soft) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  add_wall(world, Vec3::UnitX(), 0);
  add_wall(world, -Vec3::UnitX(), -2);
  add_named_ball(world, "ball", {1, 0, 0}, {60, 0, 0});  // 1 m to go: every 17 ms
  world.advance(1);
  EXPECT_EQ(count_of(world.statistics(), "fusions"), 0);
  EXPECT_EQ(count_of(world.statistics(), "collisions"), 60);
  World cradle;
  cradle_scene(100).fill(cradle);
  cradle.advance(100);
  EXPECT_EQ(count_of(cradle.statistics(), "fusions"), 0);
}

// Balls knock about in corners and between neighbours: quick runs of impacts that nothing holds
// together.
TEST(SoftImpacts, dense_elastic_gas_is_not_soft) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  add_walls(world, 0, 3);
  Random random(3);
  for (int k = 0; k < 64; ++k)
    add_ball(world, 0.25, 0.75 * Vec3(k % 4, k / 4 % 4, k / 16) + Vec3::Constant(0.375),
             random_vector(random, 4));
  world.advance(long_tests() ? 200 : 20);
  EXPECT_EQ(count_of(world.statistics(), "fusions"), 0);
  EXPECT_GT(count_of(world.statistics(), "collisions"), 5000);
}

}  // namespace
}  // namespace tw::test
