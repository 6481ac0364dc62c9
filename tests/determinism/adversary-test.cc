// The committed history under adversary schedulers: the same bits as in order.
//
// In order the kernel hardly ever rolls back, so these are the tests of rollback; each expects that
// rollbacks did occur.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "determinism/compare-schedules.h"
#include "support/scenes.h"

namespace tw::test {
namespace {

void expect_same_under_adversaries(const Scene& scene, std::int64_t least_collisions) {
  const Tally tally = expect_one_history(scene, adversaries(adversary_seeds), least_collisions);
  EXPECT_GT(tally.rollbacks, adversary_seeds) << scene.name << ": the adversaries did nothing";
}

TEST(Adversary, gas_of_100) { expect_same_under_adversaries(gas_scene(100), 100); }

TEST(Adversary, gas_of_200) { expect_same_under_adversaries(gas_scene(200), 300); }

TEST(Adversary, lattice_that_hits_at_the_same_instants) {
  expect_same_under_adversaries(lattice_scene(4, 1, long_tests() ? 20 : 5), 200);
}

TEST(Adversary, lattice_that_hits_at_the_same_instants_up_to_rounding) {
  expect_same_under_adversaries(lattice_scene(4, 1.1, long_tests() ? 20 : 5), 200);
}

TEST(Adversary, lattice_of_216) {
  expect_same_under_adversaries(lattice_scene(6, 1, long_tests() ? 10 : 3), 500);
}

TEST(Adversary, lattice_of_216_up_to_rounding) {
  expect_same_under_adversaries(lattice_scene(6, 1.1, long_tests() ? 10 : 3), 400);
}

TEST(Adversary, cradle_hit_from_both_sides_at_once) {
  expect_same_under_adversaries(cradle_scene(40), 50);
}

TEST(Adversary, floor_of_36_bouncing_balls) { expect_same_under_adversaries(floor_scene(1.5), 50); }

TEST(Adversary, cubes_that_meet_face_on_at_the_same_instants) {
  const int most =
      long_tests() ? adversary_seeds : 8;  // cubes that slide past each other cost many checks
  expect_one_history(cube_lattice_scene(3, 1, 1), adversaries(most), 40);
}

TEST(Adversary, cubes_that_meet_face_on_up_to_rounding) {
  expect_same_under_adversaries(cube_lattice_scene(3, 1.1, long_tests() ? 5 : 2), 40);
}

TEST(Adversary, tray_and_bat_that_move_by_procedures) {
  expect_same_under_adversaries(procedure_scene(long_tests() ? 3 : 2), 10);
}

TEST(Adversary, spheres_molecules_boxes_and_rocks) {
  expect_same_under_adversaries(mixture_scene(32, 5, 0, long_tests() ? 5 : 1), 20);
}

TEST(Adversary, spheres_molecules_boxes_and_rocks_with_friction) {
  expect_same_under_adversaries(mixture_scene(32, 5, 0.3, long_tests() ? 5 : 1), 20);
}

TEST(Adversary, paddle_and_divider_among_balls_and_boxes) {
  expect_same_under_adversaries(paddle_scene(long_tests() ? 4 : 1.5), 20);
}

}  // namespace
}  // namespace tw::test
