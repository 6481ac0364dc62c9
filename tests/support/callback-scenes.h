// Scenes with callbacks: a lattice of balls with counters that decide about velocities.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "support/counter.h"
#include "support/scenes.h"

namespace tw::test {

// An n^3 lattice (spacing 1: exact coincidences) whose balls count their collisions in a slot.
inline std::vector<BodyId> add_counting_lattice(World& world, int n, double spacing) {
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  add_walls(world, -0.5 * spacing, (n - 0.5) * spacing);
  CollisionCallbackDef count;
  count.name = "count";
  count.callback = std::make_shared<CountCollisions>();
  world.add_collision_callback(count);

  std::vector<BodyId> balls;
  Random random(17);
  for (int k = 0; k < n * n * n; ++k) {
    BodyDef def = body_of(make_sphere(0.25), spacing * Vec3(k % n, k / n % n, k / (n * n)),
                          random_axis(random));
    def.slots = make_counter();
    balls.push_back(world.add_body(def));
  }
  return balls;
}

// 20 Hz on every ball: an odd counter permutes the velocity.
inline Scene callback_on_every_body_scene(int n, double spacing, double duration) {
  const auto fill_world = [=](World& world) {
    for (const BodyId ball : add_counting_lattice(world, n, spacing))
      add_callback(world, {ball}, 0.05, 0.05, [](double, std::span<StateView* const> targets) {
        StateView& view = *targets[0];
        if (counter_of(view.slots()) % 2) view.set_velocity(permuted(view.state().velocity));
        return std::nullopt;
      });
  };
  return {"callbacks on bodies " + show(spacing), duration, fill_world};
}

// 20 Hz on pairs: the counter of one, which is only read, decides about the other's velocity.
inline Scene callback_on_pairs_scene(int n, double spacing, double duration) {
  const auto fill_world = [=](World& world) {
    const auto balls = add_counting_lattice(world, n, spacing);
    for (std::size_t i = 0; i + 1 < balls.size(); i += 3)
      add_callback(world, {balls[i], balls[balls.size() - 1 - i]}, 0.05, 0.05,
                   [](double, std::span<StateView* const> targets) {
                     const StateView& read = *targets[1];
                     if (counter_of(read.slots()) % 2)
                       targets[0]->set_velocity(permuted(targets[0]->state().velocity));
                     return std::nullopt;
                   });
  };
  return {"callbacks on pairs " + show(spacing), duration, fill_world};
}

// Without a period: each call draws the time of the next from the generator in the state, and every
// third draw turns the velocity.
inline Scene callback_without_period_scene(int n, double spacing, double duration) {
  const auto fill_world = [=](World& world) {
    for (const BodyId ball : add_counting_lattice(world, n, spacing))
      add_callback(world, {ball}, 0.01, std::nullopt,
                   [](double event_time, std::span<StateView* const> targets) {
                     const double draw = targets[0]->draw_random();
                     if (draw < 1.0 / 3)
                       targets[0]->set_velocity(permuted(targets[0]->state().velocity));
                     return std::optional<double>(event_time + 0.02 + 0.1 * draw);
                   });
  };
  return {"callbacks without a period " + show(spacing), duration, fill_world};
}

}  // namespace tw::test
