// Callbacks, edits, checkpoints and errors on members of contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <set>

#include "rollback/kernel-access.h"
#include "support/counter.h"
#include "support/heap-scenes.h"
#include "support/multibody-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

using Members = std::vector<BodyId>;

// Three boxes on each other on the floor, and a ball that rolls toward nothing.
struct Stack {
  // `gap`: between the boxes at the start, m; 0: groups are born at 0 s.
  explicit Stack(const Schedule& schedule = Schedule(), double gap = 5e-4) {
    apply(world, schedule);
    set_contact_for_all(world, 0.2, 0.5);
    add_block(world, {10, 10, 1}, {0, 0, -0.5});
    for (int i = 0; i < 3; ++i)
      boxes.push_back(add_box(world, {0.4, 0.4, 0.2}, {0.01 * i, 0, 0.1 + gap + (0.2 + gap) * i}));
    ball = add_ball(world, 0.1, {2, 0, 0.15}, {0, 0.3, 0});
  }
  bool at_rest(BodyId id) {
    const State* s = state_at(world.kernel().simulation, id, world.time());
    return s->group && s->group->at_rest;
  }
  World world;
  Members boxes;
  BodyId ball = 0;
};

Schedule short_adversary(std::uint64_t seed) {
  Schedule schedule = adversary_schedule(seed);
  schedule.adversary->head_start = 0.02 * (1 + static_cast<double>(seed % 5) * 3);
  schedule.check = true;
  return schedule;
}

std::vector<double> motion(World& world) {
  std::vector<double> numbers;
  for (BodyId id = 0; id < world.body_count(); ++id) {
    const BodyState s = world.state(id);
    for (int i = 0; i < 3; ++i) numbers.push_back(s.position[i]);
    for (int i = 0; i < 4; ++i) numbers.push_back(s.orientation.coeffs()[i]);
    for (int i = 0; i < 3; ++i) numbers.push_back(s.velocity[i]);
    for (int i = 0; i < 3; ++i) numbers.push_back(s.angular_velocity[i]);
  }
  return numbers;
}

// A callback that reads members leaves their arcs alone: the same motion bit for bit, no group
// more.
TEST(GroupCallbacks, that_read_a_member_leave_its_motion_alone) {
  Stack quiet;
  quiet.world.advance(0.5);
  const std::vector<double> expected = motion(quiet.world);
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Stack read(seed ? short_adversary(seed) : Schedule());
    long calls = 0;
    double height = 0;
    add_callback(read.world, {read.boxes[1], read.ball}, 0, 1 / 480.0,
                 [&](double, std::span<StateView* const> targets) {
                   ++calls;
                   height += targets[0]->state().position.z();
                   return std::nullopt;
                 });
    read.world.advance(0.5);
    EXPECT_GT(calls, 200);
    EXPECT_EQ(motion(read.world), expected) << "seed " << seed;
    if (seed == 0) {
      EXPECT_EQ(count_of(read.world.statistics(), "groups"),
                count_of(quiet.world.statistics(), "groups"));
    }
  }
}

// What a callback changes, the group takes up, under every schedule.
void expect_pushes_alike(double gap, double start, double period,
                         const std::function<void(StateView&)>& push) {
  std::string expected;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Stack scene(seed ? short_adversary(seed) : Schedule(), gap);
    scene.world.set_group_check_rate(512);
    add_callback(scene.world, {scene.boxes[1]}, start, period,
                 [&](double, std::span<StateView* const> targets) {
                   push(*targets[0]);
                   return std::nullopt;
                 });
    scene.world.advance(0.6);
    if (seed == 0) {
      expected = scene.world.history_hash();
      Stack left_alone(Schedule(), gap);
      left_alone.world.advance(0.6);
      const Vec3 moved = scene.world.state(scene.boxes[1]).position -
                         left_alone.world.state(left_alone.boxes[1]).position;
      EXPECT_GT(moved.norm(), 1e-3) << "the push had no effect";
    }
    EXPECT_EQ(scene.world.history_hash(), expected) << "seed " << seed;
  }
}

TEST(GroupCallbacks, that_set_a_velocity_start_the_group_anew) {
  expect_pushes_alike(5e-4, 0.25, 0.125, [](StateView& view) {
    view.set_velocity(view.state().velocity + Vec3(0.3, 0, 0));
  });
}

TEST(GroupCallbacks, that_set_a_force_start_the_group_anew) {
  expect_pushes_alike(5e-4, 0.1, 0.0625, [](StateView& view) {
    view.set_applied_force(view.applied_force() + Vec3(60, 20, 0));
  });
}

// The groups are born at 0 s, so checks lie on multiples of 1/512 s: a callback comes before the
// check of its instant.
TEST(GroupCallbacks, at_the_very_instants_of_group_checks) {
  expect_pushes_alike(0, 0.125, 1 / 64.0, [](StateView& view) {
    if (view.state().velocity.x() < 0.1) view.set_velocity(view.state().velocity + Vec3(0.2, 0, 0));
  });
}

TEST(GroupCallbacks, that_throw_a_member_up_end_in_a_fission) {
  Stack scene;
  add_callback(scene.world, {scene.boxes[2]}, 0.3, 10, [](double, std::span<StateView* const> t) {
    t[0]->set_velocity({0, 0, 2});
    return std::nullopt;
  });
  scene.world.advance(0.29);
  KernelTest kernel(scene.world);
  ASSERT_EQ(members_of(*kernel.tail(scene.boxes[2]).group), scene.boxes);
  scene.world.advance(0.4);
  EXPECT_FALSE(kernel.tail(scene.boxes[2]).group);
  EXPECT_EQ(members_of(*kernel.tail(scene.boxes[0]).group),
            (Members{scene.boxes[0], scene.boxes[1]}));
}

// Between runs.  `change` is made at 0.25 s, while the stack settles, and at 1.5 s, when it rests.
void expect_edit_wakes(const std::function<void(World&, const Members&)>& change) {
  for (const double when : {0.25, 1.5}) {
    std::string expected;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      Stack scene(seed ? short_adversary(seed) : Schedule());
      scene.world.advance(when);
      if (when > 1) {
        ASSERT_TRUE(scene.at_rest(scene.boxes[0])) << "the stack never came to rest";
      }
      const Vec3 before = scene.world.state(scene.boxes[2]).position;
      change(scene.world, scene.boxes);
      scene.world.advance(when + 0.1);
      EXPECT_GT((scene.world.state(scene.boxes[2]).position - before).norm(), 1e-6)
          << "at " << when;
      scene.world.advance(when + 0.3);
      if (seed == 0) expected = scene.world.history_hash();
      EXPECT_EQ(scene.world.history_hash(), expected) << "seed " << seed << " at " << when;
    }
  }
}

TEST(GroupEdits, velocity_of_a_member_wakes_its_group) {
  expect_edit_wakes([](World& world, const Members& boxes) {
    world.edit(boxes[0], [](StateView& view) { view.set_velocity({1, 0, 0}); });
  });
}

// What touches where it was put touches after all that was set of it in the same pause.
TEST(GroupEdits, of_what_was_put_in_touch_in_the_same_pause_hold) {
  constexpr double mu = 0.5, g = 9.81;
  World world;
  set_contact_for_all(world, 0, mu);
  add_wall(world, Vec3::UnitZ(), 0);
  world.advance(0.1);
  const BodyId first = add_box(world, {1, 1, 1}, {0, 0, 0.5});
  world.edit(first, [](StateView& view) { view.set_velocity({2, 0, 0}); });
  world.advance(0.2);
  EXPECT_NEAR(world.state(first).velocity.x(), 2 - mu * g * 0.1, 1e-3);
  // a second one beside it, after which the first is set again
  const BodyId second = add_box(world, {1, 1, 1}, world.state(first).position - Vec3(0, 1, 0));
  world.edit(first, [](StateView& view) { view.set_velocity({3, 0, 0}); });
  world.edit(second, [](StateView& view) { view.set_velocity({3, 0, 0}); });
  world.advance(0.3);
  for (const BodyId id : {first, second})
    EXPECT_NEAR(world.state(id).velocity.x(), 3 - mu * g * 0.1, 2e-2);
}

TEST(GroupEdits, force_on_a_member_wakes_its_group) {
  expect_edit_wakes([](World& world, const Members& boxes) {
    world.edit(boxes[2], [](StateView& view) { view.set_applied_force({600, 0, 0}); });
  });
}

TEST(GroupEdits, pose_of_the_lowest_lets_the_others_fall) {
  expect_edit_wakes([](World& world, const Members& boxes) {
    world.edit(boxes[0], [](StateView& view) {
      view.set_pose(view.state().position + Vec3(1, 0, 0.5), view.state().orientation);
    });
  });
}

TEST(GroupEdits, gravity_wakes_groups) {
  expect_edit_wakes([](World& world, const Members&) { world.set_gravity({8, 0, -3}); });
}

// All of a heap get new arcs at once: not a group for each member, whose neighbours still fall the
// old way.
TEST(GroupEdits, gravity_and_parameters_make_each_group_once) {
  World world;
  heap_scene(40, 0).fill(world);
  world.advance(1);
  const auto groups = [&] { return count_of(world.statistics(), "groups"); };
  KernelTest kernel(world);
  std::set<const Group*> standing;
  for (BodyId id = 0; id < world.body_count(); ++id)
    if (const auto& group = kernel.tail(id).group) standing.insert(group.get());
  ASSERT_GT(standing.size(), 0u);
  const auto made_by = [&](const std::function<void()>& change) {
    const std::int64_t before = groups();
    change();
    return groups() - before;
  };
  const auto most = static_cast<std::int64_t>(standing.size());
  EXPECT_LE(made_by([&] { world.set_gravity({1, 0, -9}); }), most);
  EXPECT_LE(made_by([&] { set_contact_for_all(world, 0.1, 0.3); }), most);
  // and all of them fall the new way, whoever was changed first
  for (BodyId id = 0; id < world.body_count(); ++id)
    if (world.body(id).kind == BodyKind::dynamic) {
      EXPECT_EQ(kernel.tail(id).acceleration, Vec3(1, 0, -9));
    }
  EXPECT_NO_THROW(world.advance(1.2));
}

TEST(GroupEdits, friction_set_to_nothing_lets_a_tilted_stack_slide) {
  Stack scene;
  scene.world.set_gravity({1, 0, -9.81});
  scene.world.advance(2);
  ASSERT_TRUE(scene.at_rest(scene.boxes[2]));
  const Vec3 before = scene.world.state(scene.boxes[2]).position;
  set_contact_for_all(scene.world, 0, 0);
  scene.world.advance(2.5);
  EXPECT_GT((scene.world.state(scene.boxes[2]).position - before).norm(), 0.05);
}

// A run that goes on from a checkpoint in the middle of a heap commits the same history.
TEST(GroupCheckpoints, run_from_a_checkpoint_in_a_heap_is_the_same) {
  const Scene scene = heap_scene(8, 1.2);
  const std::string expected = run(scene, Schedule()).hash;
  for (const double when : {0.3, 0.55, 0.9})
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      World world;
      apply(world, seed ? short_adversary(seed) : Schedule());
      scene.fill(world);
      world.advance(when);
      const auto checkpoint = world.checkpoint();
      for (const double past : {when + 0.1, scene.duration}) {
        world.advance(past);
        world.restore(*checkpoint);
        EXPECT_EQ(KernelTest(world).validate_event_queue(), "");
        EXPECT_EQ(validate_residences(world.kernel().simulation), "");
      }
      world.advance(scene.duration);
      EXPECT_EQ(world.history_hash(), expected) << "at " << when << ", seed " << seed;
    }
}

// The state of a heap at rest comes back at rest.
TEST(GroupCheckpoints, stack_at_rest_comes_back_at_rest) {
  Stack scene;
  scene.world.advance(1.5);
  ASSERT_TRUE(scene.at_rest(scene.boxes[0]));
  const auto checkpoint = scene.world.checkpoint();
  const std::vector<double> expected = motion(scene.world);
  scene.world.edit(scene.boxes[0], [](StateView& view) { view.set_velocity({2, 0, 0}); });
  scene.world.advance(2);
  scene.world.restore(*checkpoint);
  EXPECT_TRUE(scene.at_rest(scene.boxes[0]));
  EXPECT_EQ(motion(scene.world), expected);
}

// Contact parameters are part of a checkpoint: what rested by those of then rests again.
TEST(GroupCheckpoints, contact_parameters_come_back_with_what_rested_by_them) {
  Stack scene;
  scene.world.set_gravity({1, 0, -9.81});
  scene.world.advance(2);
  ASSERT_TRUE(scene.at_rest(scene.boxes[2]));
  const auto checkpoint = scene.world.checkpoint();
  const Vec3 before = scene.world.state(scene.boxes[2]).position;
  for (int time = 0; time < 2; ++time) {
    set_contact_for_all(scene.world, 0, 0);
    scene.world.advance(2.5);
    EXPECT_GT((scene.world.state(scene.boxes[2]).position - before).norm(), 0.05);
    scene.world.restore(*checkpoint);
    EXPECT_EQ(scene.world.state(scene.boxes[2]).position, before);
    scene.world.advance(2.5);
    EXPECT_EQ(scene.world.state(scene.boxes[2]).position, before);
    scene.world.restore(*checkpoint);
  }
}

// A callback's error on a member stops its group, and is raised once it is final.
TEST(GroupErrors, error_of_a_callback_on_a_member_is_raised_at_its_time) {
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (int member = 0; member < 3; ++member) {
      Stack scene(seed ? short_adversary(seed) : Schedule());
      add_callback(scene.world, {scene.boxes[static_cast<std::size_t>(member)]}, 0.3, 10,
                   [](double, std::span<StateView* const>) -> std::optional<double> {
                     throw UserError("no more");
                   });
      try {
        ASSERT_NE(scene.world.advance(1, 2), RunStatus::slice_over)
            << "seed " << seed << " " << member;
        FAIL() << "no error";
      } catch (const UserError& error) {
        EXPECT_STREQ(error.what(), "no more");
      }
      EXPECT_EQ(scene.world.time(), 0.3);
    }
}

// How far apart two links hung says nothing of where they are put: one swings into the other.
TEST(GroupEdits, links_put_elsewhere_meet_there) {
  for (const double other : {0.5, 0.6}) {
    World world;
    world.set_gravity(Vec3::Zero());
    std::vector<std::uint32_t> arms;
    for (const double x : {0.0, 0.15}) {
      MultibodyDef arm = chain(1, 0.5, {x, 0, 0});
      arm.name += std::to_string(arms.size());
      arms.push_back(world.add_multibody(arm));
    }
    // off hanging, which level is pi/2 away from
    set_joint(world, arms[0], 0, 0.5 * pi + 0.6);
    set_joint(world, arms[1], 0, 0.5 * pi + other);
    set_velocity(world, arms[0], 0, -3);
    world.advance(0.3);
    EXPECT_GE(count_of(world.statistics(), "collisions"), 1) << other;
    EXPECT_LT(world.joints(arms[1]).u[0], -0.1) << other;
  }
}

// An error that a callback throws in a future that never comes leaves no trace.
TEST(GroupErrors, errors_on_members_are_speculative) {
  int thrown = 0;
  std::string expected;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Schedule schedule;
    if (seed) {
      schedule = adversary_schedule(seed);
      schedule.adversary->head_start = 0.3;
    }
    Stack scene(schedule);
    // a ball comes from above and sends the uppermost box away before the callback looks
    add_ball(scene.world, 0.1, {-1, 0, 0.5}, {8, 0, 0.6});
    add_callback(scene.world, {scene.boxes[2]}, 0.25, 10,
                 [&](double, std::span<StateView* const> t) -> std::optional<double> {
                   if (t[0]->state().position.x() > 0.04) return std::nullopt;
                   ++thrown;
                   throw UserError("not moved");
                 });
    EXPECT_NO_THROW(scene.world.advance(0.5)) << "seed " << seed;
    if (seed == 0) expected = scene.world.history_hash();
    EXPECT_EQ(scene.world.history_hash(), expected) << "seed " << seed;
  }
  EXPECT_GT(thrown, 5) << "the adversaries never ran the callback too early";
}

}  // namespace
}  // namespace tw::test
