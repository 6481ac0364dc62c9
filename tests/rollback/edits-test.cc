// Changes between runs: edits, new bodies, parameters; under every schedule the same history.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/callback-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

using Change = std::function<void(World&)>;

// Runs to 0.7 s, changes something, runs to 2 s; the same under 20 adversaries and in pieces.
void expect_one_history(const Change& change, bool has_effect = true) {
  const Scene scene = lattice_scene(3, 1.1, 2);
  const auto hash = [&](const Schedule& schedule, bool changed) {
    World world;
    apply(world, schedule);
    scene.fill(world);
    advance_in_pieces(world, 0.7, schedule.pieces);
    if (changed) change(world);
    advance_in_pieces(world, 0.7, 1);
    world.advance(1.1);
    world.advance(2);
    return world.history_hash();
  };
  const std::string expected = hash(Schedule(), true);
  if (has_effect) {
    EXPECT_NE(expected, hash(Schedule(), false));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.pieces = 1 + static_cast<int>(seed % 4);
    schedule.check = seed < 4;
    EXPECT_EQ(hash(schedule, true), expected) << describe(schedule);
  }
}

TEST(Edits, velocity) {
  expect_one_history([](World& world) {
    world.edit(10, [](StateView& view) {
      view.set_velocity(permuted(view.state().velocity) + Vec3(0.1, 0, 0));
    });
  });
}

TEST(Edits, velocity_and_force_of_many_in_turn) {
  expect_one_history([](World& world) {
    for (BodyId id = 6; id < 20; id += 2) {
      world.edit(id, [](StateView& view) { view.set_velocity({0.5, 0.25, 0}); });
      world.edit(id, [](StateView& view) { view.set_applied_force({0, 0, 3}); });
      world.edit(id, [](StateView& view) { view.set_angular_velocity({0, 1, 3}); });
    }
  });
}

TEST(Edits, pose) {
  expect_one_history([](World& world) {
    // balls 6 and 7 trade places a little apart from the others
    world.edit(6, [](StateView& view) {
      view.set_pose(view.state().position + Vec3(0.02, 0.01, 0.01), Quat::Identity());
    });
  });
}

TEST(Edits, new_body) {
  expect_one_history([](World& world) { add_ball(world, 0.05, {0.55, 0.55, 0.55}, {0, 0, 0.5}); });
}

TEST(Edits, new_wall) {
  expect_one_history([](World& world) { add_wall(world, Vec3(1, 1, 1), -0.2); });
}

TEST(Edits, restitution) {
  expect_one_history([](World& world) { set_contact_for_all(world, 0.9, 0); });
}

TEST(Edits, gravity) {
  expect_one_history([](World& world) { world.set_gravity({0, 0, -1}); });
}

TEST(Edits, new_callback) {
  expect_one_history([](World& world) {
    add_callback(world, {8, 9}, 0, 0.125, [](double, std::span<StateView* const> targets) {
      targets[0]->set_velocity(permuted(targets[1]->state().velocity));
      return std::nullopt;
    });
  });
}

TEST(Edits, disabled_collisions) {
  expect_one_history([](World& world) {
    ContactSettings settings;
    settings.collide = false;
    for (BodyId id = 6; id < 30; ++id) {
      ContactSide side;
      side.kind = ContactSide::Kind::body;
      side.body = id;
      ContactSide walls;
      walls.kind = ContactSide::Kind::body;
      walls.body = id % 6;
      world.set_contact(side, walls, settings);
    }
  });
}

// A new observer changes nothing of the motion.
TEST(Edits, new_observer) {
  expect_one_history([](World& world) { world.add_collision_observer([](const Collision&) {}); },
                     false);
}

// An edit at the very time of impacts comes after them.
TEST(Edits, at_the_instant_of_impacts) {
  std::string expected;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    World world;
    apply(world, seed == 0 ? Schedule() : adversary_schedule(seed));
    lattice_scene(4, 1, 2).fill(world);
    for (const double stop : {0.25, 0.5, 0.75, 1.0}) {
      world.advance(stop);
      for (BodyId id = 6; id < 70; id += 5)
        world.edit(id, [](StateView& view) { view.set_velocity(permuted(view.state().velocity)); });
    }
    world.advance(2);
    if (seed == 0) expected = world.history_hash();
    EXPECT_EQ(world.history_hash(), expected) << "seed " << seed;
    EXPECT_NEAR(world.total_energy(), 64 * 0.5 * world.body(6).mass, 1e-9);
  }
}

// An edit that moves a ball into another is refused by name, and the next run is as if it were not.
TEST(Edits, overlapping_pose_is_an_error_with_names) {
  World world;
  lattice_scene(3, 1, 2).fill(world);
  world.advance(0.1);
  try {
    const Vec3 there = world.state(8).position + Vec3(0.1, 0, 0);
    world.edit(7, [&](StateView& view) { view.set_pose(there, Quat::Identity()); });
    FAIL() << "no error";
  } catch (const UserError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("body-7"), std::string::npos) << message;
    EXPECT_NE(message.find("body-8"), std::string::npos) << message;
    EXPECT_NE(message.find("overlap"), std::string::npos) << message;
  }
}

TEST(Edits, fixed_bodies_cannot_be_moved) {
  World world;
  const BodyId wall = add_wall(world, Vec3::UnitZ(), 0);
  EXPECT_THROW(world.edit(wall, [](StateView& v) { v.set_velocity({1, 0, 0}); }), UserError);
  EXPECT_THROW(world.edit(wall, [](StateView& v) { v.set_applied_force({1, 0, 0}); }), UserError);
  const BodyId ball = add_ball(world, 1, {0, 0, 3}, Vec3::Zero());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(world.edit(ball, [&](StateView& v) { v.set_velocity({nan, 0, 0}); }), UserError);
  EXPECT_EQ(world.state(ball).velocity, Vec3::Zero());
}

// No discontinuity is needed where nothing has begun, yet the arc is another.
TEST(Edits, gravity_that_is_set_before_the_first_run_holds_for_bodies_that_are_there) {
  World world;
  world.set_check(true);
  const BodyId ball = add_ball(world, 1, {0, 0, 3}, {1, 0, 0});
  world.set_gravity({0, 0, -10});
  world.advance(0.2);
  EXPECT_LT((world.state(ball).position - Vec3(0.2, 0, 2.8)).norm(), 1e-14);
  EXPECT_LT((world.state(ball).velocity - Vec3(1, 0, -2)).norm(), 1e-14);
}

// The test mode that takes everything back once would not find an edit again.
TEST(Edits, outlast_undo_redo) {
  World world;
  world.set_undo_redo(true);
  world.set_gravity(Vec3::Zero());
  const BodyId ball = add_ball(world, 0.1, Vec3::Zero(), Vec3::Zero());
  world.edit(ball, [](StateView& view) { view.set_velocity({1, 0, 0}); });
  world.advance(1);
  EXPECT_EQ(world.state(ball).position, Vec3(1, 0, 0));
  world.edit(ball, [](StateView& view) { view.set_velocity({0, 2, 0}); });
  world.advance(2);
  EXPECT_EQ(world.state(ball).position, Vec3(1, 2, 0));
}

}  // namespace
}  // namespace tw::test
