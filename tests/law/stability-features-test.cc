// Joints, stops, servos, moving bases, holds, springs, height fields, round shapes, rolling
// friction, fine hulls, procedures and policies under strain: shrunk from doc/stability.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/stability-features.h"

namespace tw::test {
namespace {

// No error, no stall, no gain of energy beyond `rise` of that at the start, no overlap beyond two
// thousandths of the smaller body's width.
StabilityOutcome expect_sound(const StabilityScene& scene, double rise) {
  StabilityRun run(scene, ample_budget);
  const StabilityOutcome o = run.run();
  EXPECT_EQ(o.error, "") << scene.name;
  EXPECT_FALSE(o.stalled) << scene.name << " at " << o.reached << " s";
  EXPECT_FALSE(o.sunk) << scene.name;
  EXPECT_LE(scene.driven ? 0 : o.rise_share(), rise) << scene.name << " at " << o.rise_time << " s";
  EXPECT_LE(o.deepest_share, 2e-3) << scene.name << " " << o.deepest_pair;
  return o;
}

StabilityOutcome heap(const FeatureHeap& heap, double duration) {
  return expect_sound(feature_heap_scene(heap, duration), 1e-4);
}

TEST(StabilityFeatures, chains_swing_whatever_hangs_on_them_and_fall_on_the_floor) {
  expect_sound(heavy_chain_scene(1e3, 3), 1e-6);
  expect_sound(heavy_chain_scene(1e6, 1), 1e-4);
  expect_sound(fallen_chain_scene(10, 3), 1e-5);
}

TEST(StabilityFeatures, flaps_come_to_rest_on_their_stops) {
  for (const double e : {0.0, 0.9})
    EXPECT_TRUE(expect_sound(flaps_scene(e, 8), 1e-4).at_rest()) << e;
}

// The load bends the arm as its servos' stiffness says: a thousandth of a thousand times.
TEST(StabilityFeatures, servos_hold_an_arm_level) {
  const double soft = expect_sound(servo_scene(10, 1e3, 20), 0).travel;
  const double stiff = expect_sound(servo_scene(10, 1e6, 20), 0).travel;
  EXPECT_LT(soft, 0.02);
  EXPECT_NEAR(stiff, 1e-3 * soft, 1e-4 * soft);
}

TEST(StabilityFeatures, cones_joint_friction_loops_and_force_procedures_hold) {
  for (const double e : {0.0, 0.9}) expect_sound(cones_scene(e, 2), 1e-4);
  for (const double ratio : {1.0, 1e3}) {
    expect_sound(dry_chain_scene(ratio, 3), 1e-5);
    expect_sound(loop_scene(ratio, 2), 1e-5);
  }
  for (const double stiffness : {1e3, 1e5}) expect_sound(drawn_box_scene(stiffness, 3), 0);
}

TEST(StabilityFeatures, chain_on_a_shaken_base_neither_breaks_nor_runs_away) {
  EXPECT_LT(expect_sound(shaken_base_scene(5), 0).travel, 1.7);
}

TEST(StabilityFeatures, held_beams_bend_without_gain) {
  for (const double ratio : {1.0, 100.0})
    EXPECT_LT(expect_sound(held_beam_scene(10, ratio, 0.05, 5), 1e-5).travel, 0.5) << ratio;
}

TEST(StabilityFeatures, light_and_heavy_balls_in_turn_hang_on_springs) {
  expect_sound(spring_column_scene(1e3, 1e5, 3), 1e-6);
}

// With rolling and spinning friction all that is round rests.
TEST(StabilityFeatures, round_heaps_and_heaps_on_hills_come_to_rest) {
  EXPECT_TRUE(heap({"round", "", HeapOf::round, 12, false, 0.01}, 6).at_rest());
  EXPECT_TRUE(heap({"hills", "", HeapOf::mixed, 12, true, 0.01}, 6).at_rest());
}

TEST(StabilityFeatures, fine_hulls_and_a_wall_that_comes_and_goes) {
  heap({"fine", "", HeapOf::fine, 6}, 3);
  heap({"stirred", "", HeapOf::mixed, 12, false, 0, true}, 3);
}

TEST(StabilityFeatures, policies_change_nothing) {
  const auto outcome = [](const std::string& policy) {
    return heap({"policy", "", HeapOf::mixed, 9, false, 0, false, policy}, 2);
  };
  const StabilityOutcome ours = outcome("");
  for (const char* policy : {"retroactive:0.0333333", "conservative"}) {
    const StabilityOutcome other = outcome(policy);
    EXPECT_EQ(ours.energy_end, other.energy_end) << policy;
    EXPECT_EQ(ours.travel, other.travel) << policy;
    EXPECT_EQ(ours.collisions, other.collisions) << policy;
  }
}

}  // namespace
}  // namespace tw::test
