// Energy of elastic gases over long times.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

TEST(Energy, of_200_elastic_spheres_drifts_by_less_than_1e_10_in_120_s) {
  World world;
  gas_scene(200).fill(world);
  world.advance(120);
  const auto table = world.statistics();
  const double start = number_of(table, "energy_start"), end = number_of(table, "energy_end");
  EXPECT_LT(std::abs(end - start), 1e-10 * start);
  EXPECT_GT(count_of(table, "collisions"), 15000);
  RecordProperty("relative_drift", std::to_string((end - start) / start));
  std::printf("  %d collisions, relative drift %.2e\n",
              static_cast<int>(count_of(table, "collisions")), (end - start) / start);
}

TEST(Energy, of_spheres_molecules_boxes_and_rocks_drifts_by_less_than_1e_10) {
  World world;
  const Scene scene = mixture_scene(32, 5, 0, long_tests() ? 60 : 5);
  scene.fill(world);
  world.advance(scene.duration);
  const auto table = world.statistics();
  const double start = number_of(table, "energy_start"), end = number_of(table, "energy_end");
  EXPECT_LT(std::abs(end - start), 1e-10 * start);
  EXPECT_LT(number_of(table, "max_penetration"), 1e-9);
  std::printf("  %d collisions, relative drift %.2e, deepest %.1e m\n",
              static_cast<int>(count_of(table, "collisions")), (end - start) / start,
              number_of(table, "max_penetration"));
}

// Restitution below 1 and friction only take energy.
TEST(Energy, never_grows_with_friction_and_restitution) {
  World world;
  mixture_scene(32, 5, 0.4, 3).fill(world);
  set_contact_for_all(world, 0.9, 0.4);
  double before = world.total_energy();
  for (int i = 1; i <= 60; ++i) {
    world.advance(0.05 * i);
    const double now = world.total_energy();
    EXPECT_LE(now, before * (1 + 1e-13));
    before = now;
  }
}

}  // namespace
}  // namespace tw::test
