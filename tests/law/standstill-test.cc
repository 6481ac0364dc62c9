// Simulated time goes on: what it takes to go through scenes that once stood still.
//
// Counted, not timed: collision checks and steps are functions of the scene.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/schedule.h"

namespace tw::test {
namespace {

double checks_of(World& world) { return count_of(world.statistics(), "checks"); }

// Drums in touch along lines, hit by one, or lying in a row: pairs that slide, roll and tilt
// against each other along the line.
TEST(Standstill, drums_in_touch_along_lines_go_on) {
  for (const bool heavy : {false, true}) {
    World world;
    set_contact_for_all(world, 0.4, 2);
    world.set_gravity(heavy ? Vec3(0, 0, -9.81) : Vec3(0, 0, 0));
    add_wall(world, Vec3::UnitZ(), 0);
    const double r = 0.04;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 2; ++k)
        world.add_body(
            body_of(make_cylinder(r, 2 * r), {2 * r * i, 0, r + 2 * r * k}, Vec3::Zero()));
    world.add_body(body_of(make_cylinder(r, 2 * r), {-4 * r, 0.1 * r, r}, {2, 0, 0}));
    world.advance(0.4);
    EXPECT_LT(checks_of(world), 20000) << (heavy ? "with" : "without") << " gravity";
  }
}

}  // namespace
}  // namespace tw::test
