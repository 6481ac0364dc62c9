// Regions: what a blow on a large group does when only those who feel it get new arcs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "kernel/world.h"

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

}  // namespace
}  // namespace tw::test
