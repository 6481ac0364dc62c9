// Regions: what a blow on a large group does when only those who feel it get new arcs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/counter.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// A row of touching cubes on smooth ground, and one more that runs into its end at `speed`.
std::vector<BodyId> row_with_blow(World& world, int count, double speed) {
  ContactSettings smooth;
  smooth.restitution = 0;
  smooth.friction = 0;
  world.set_contact({}, {}, smooth);
  BodyDef ground;
  ground.shape = make_half_space(Vec3::UnitZ(), 0);
  ground.fixed = true;
  world.add_body(ground);
  std::vector<BodyId> row;
  for (int i = 0; i <= count; ++i) {
    BodyDef cube;
    cube.shape = make_box({1, 1, 1});
    cube.density = 1;
    cube.position = Vec3(i < count ? i : -1 - 0.3 * speed, 0, 0.5);
    if (i == count) cube.velocity = Vec3(speed, 0, 0);
    row.push_back(world.add_body(cube));
  }
  return row;
}

// The blow runs down the row, from region to region: none of its momentum gets lost at their
// borders beyond what steps may be wrong by, and no energy comes from there.
TEST(Region, a_blow_runs_down_a_row_with_its_momentum) {
  for (const double speed : {0.3, 1.0, 3.0}) {
    World world;
    world.set_accuracy(1e-6);
    const std::vector<BodyId> row = row_with_blow(world, 16, speed);
    const double at_rest = world.total_energy() - 0.5 * speed * speed;
    double least = at_rest + 0.5 * speed * speed;
    for (int i = 1; i <= 100; ++i) {
      world.advance(0.01 * i);
      EXPECT_NEAR(world.total_momentum().x(), speed, 5e-3 * speed)
          << speed << " m/s, " << 0.01 * i << " s";
      const double energy = world.total_energy();
      EXPECT_LT(energy, least + 1e-3 * speed * speed) << 0.01 * i << " s";
      least = std::min(least, energy);
    }
    // it arrived
    EXPECT_GT(world.state(row[15]).velocity.x(), 0.1 * speed);
    EXPECT_LT(world.state(row[0]).velocity.x(), 0.05 * speed);
  }
}

// Measured: 2.4e-4, 8e-5, 2.1e-4 and 1.5e-4.  With borders that may miss all of a step's tolerance,
// and tolerances that do not shrink with the speed, 1e-4 ended with 2.8 times the momentum.
TEST(Region, the_momentum_of_a_row_is_kept_at_any_accuracy) {
  for (const double accuracy : {1e-6, 1e-5, 5e-5, 1e-4}) {
    World world;
    world.set_accuracy(accuracy);
    row_with_blow(world, 16, 1);
    world.advance(1);
    EXPECT_NEAR(world.total_momentum().x(), 1, 1e-3) << accuracy;
  }
}

// A tower on smooth ground, a disc on it, and on the disc a ball.  All rest; then the ball is spun
// about the vertical, and spinning friction between the two turns the disc, by no force.  What they
// have of angular momentum stays: I w = (I + I') w' when they turn as one.
TEST(Region, what_rests_wakes_where_the_torque_on_it_changes) {
  constexpr int height = 10;
  constexpr double edge = 0.2;
  const Vec3 spin(0, 0, 5);
  World world;
  ContactSettings smooth;
  smooth.restitution = 0;
  smooth.friction = 0;
  world.set_contact({}, {}, smooth);
  add_wall(world, Vec3::UnitZ(), 0);
  for (int i = 0; i < height; ++i)
    world.add_body(body_of(make_box({edge, edge, edge}), {0, 0, (i + 0.5) * edge}, Vec3::Zero()));
  BodyDef def = body_of(make_cylinder(0.1, 0.05), {0, 0, height * edge + 0.025}, Vec3::Zero());
  const BodyId disc = world.add_body(def);
  def = body_of(make_sphere(0.05), {0, 0, height * edge + 0.1}, Vec3::Zero());
  def.mass = world.body(disc).mass;
  const BodyId ball = world.add_body(def);
  ContactSettings spinning;
  spinning.spinning_friction = 5e-3;
  using Side = ContactSide;
  world.set_contact(Side{Side::Kind::body, "", disc}, Side{Side::Kind::body, "", ball}, spinning);
  add_callback(world, {ball}, 2, std::nullopt, [spin](double, std::span<StateView* const> targets) {
    targets[0]->set_angular_velocity(spin);
    return std::optional<double>();
  });
  world.advance(1.9);
  EXPECT_EQ(world.survey_contacts(1.9).bodies_at_rest, static_cast<std::size_t>(height + 2));
  world.advance(2.1);
  EXPECT_EQ(world.survey_contacts(2.1).bodies_at_rest, static_cast<std::size_t>(height))
      << "the tower was woken, too, or the disc was not";
  world.advance(4);
  const double of_ball = 0.4 * 0.05 * 0.05, of_disc = 0.5 * 0.1 * 0.1;
  const double together = of_ball / (of_ball + of_disc) * spin.z();
  EXPECT_NEAR(world.state(disc).angular_velocity.z(), together, 1e-3 * together);
  EXPECT_NEAR(world.state(ball).angular_velocity.z(), together, 1e-3 * together);
}

// A plank lies on a tower, a ball on its middle.  All rest; then the ball rolls along the plank,
// which feels the same force all the time, but tips when the ball, as heavy, is as far beyond the
// tower's edge as the plank's middle is before it.
TEST(Region, what_rests_wakes_where_a_force_on_it_moves) {
  constexpr int height = 10;
  const double edge = 0.2, speed = 0.5;
  World world;
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  for (int i = 0; i < height; ++i)
    world.add_body(body_of(make_box({edge, edge, edge}), {0, 0, (i + 0.5) * edge}, Vec3::Zero()));
  BodyDef def = body_of(make_box({2, edge, 0.05}), {0, 0, height * edge + 0.025}, Vec3::Zero());
  const BodyId plank = world.add_body(def);
  def = body_of(make_sphere(0.05), {0, 0, height * edge + 0.1}, Vec3::Zero());
  def.mass = world.body(plank).mass;
  const BodyId ball = world.add_body(def);
  add_callback(world, {ball}, 2, std::nullopt,
               [speed](double, std::span<StateView* const> targets) {
                 targets[0]->set_velocity({speed, 0, 0});
                 targets[0]->set_angular_velocity({0, speed / 0.05, 0});
                 return std::optional<double>();
               });
  world.advance(1.9);
  EXPECT_EQ(world.survey_contacts(1.9).bodies_at_rest, static_cast<std::size_t>(height + 2));
  const double balanced = 2 + 0.2 / speed;
  world.advance(balanced - 0.02);
  EXPECT_LT(2 * world.state(plank).orientation.vec().norm(), 5e-3) << "it tips too early";
  world.advance(balanced + 0.5);
  EXPECT_GT(2 * world.state(plank).orientation.vec().norm(), 0.1) << "it rests on nothing";
}

}  // namespace
}  // namespace tw::test
