// Callbacks under adversary schedulers: on bodies, on pairs of which one is only read, without a
// period; counters that decide about velocities and random numbers that live in states.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "determinism/compare-schedules.h"
#include "support/callback-scenes.h"

namespace tw::test {
namespace {

void expect_same_under_adversaries(const Scene& scene) {
  const Tally tally = expect_one_history(scene, adversaries(adversary_seeds), 20);
  EXPECT_GT(tally.rollbacks, adversary_seeds) << scene.name << ": the adversaries did nothing";
}

TEST(CallbackSchedules, on_every_body) {
  for (const double spacing : {1.0, 1.1})
    expect_same_under_adversaries(callback_on_every_body_scene(3, spacing, 2));
}

TEST(CallbackSchedules, on_pairs_of_which_one_is_only_read) {
  for (const double spacing : {1.0, 1.1})
    expect_same_under_adversaries(callback_on_pairs_scene(4, spacing, 2));
}

TEST(CallbackSchedules, without_a_period) {
  for (const double spacing : {1.0, 1.1})
    expect_same_under_adversaries(callback_without_period_scene(3, spacing, 2));
}

// Two callbacks at the same instants share targets crosswise; the order is that of their numbers.
TEST(CallbackSchedules, that_share_targets_at_the_same_instants) {
  const auto fill_world = [](World& world) {
    const auto balls = add_counting_lattice(world, 3, 1.1);
    const auto exchange = [](double, std::span<StateView* const> targets) {
      const Vec3 v = targets[0]->state().velocity;
      targets[0]->set_velocity(permuted(targets[1]->state().velocity));
      targets[1]->set_velocity(v);
      return std::nullopt;
    };
    for (std::size_t i = 0; i + 4 < balls.size(); i += 3) {
      add_callback(world, {balls[i], balls[i + 1]}, 0.25, 0.25, exchange);
      add_callback(world, {balls[i + 1], balls[i + 4]}, 0, 0.125, exchange);
    }
  };
  expect_same_under_adversaries({"callbacks that share targets", 2, fill_world});
}

// A force that a callback sets bends arcs: spheres in different accelerations are no exact pairs.
TEST(CallbackSchedules, that_set_forces) {
  const auto fill_world = [](World& world) {
    for (const BodyId ball : add_counting_lattice(world, 3, 1.1))
      add_callback(world, {ball}, 0.1, 0.2, [](double, std::span<StateView* const> targets) {
        const double mass = 1000 * 4.0 / 3 * pi * 0.015625;
        targets[0]->set_applied_force(mass * permuted(targets[0]->state().velocity));
        return std::nullopt;
      });
  };
  expect_same_under_adversaries({"callbacks that set forces", 1.5, fill_world});
}

}  // namespace
}  // namespace tw::test
