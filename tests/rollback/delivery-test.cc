// Delivery of what is committed: observers that throw, checkpoints with frames and undelivered
// collisions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "rollback/kernel-access.h"
#include "support/callback-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// Elastic balls that meet at grid times: dense enough to fill a batch of deliveries.
void fill_with_gas(World& world) { lattice_scene(4, 1, 3).fill(world); }

struct Failing {
  long heard = 0, fails_at = -1;
  void operator()(const Collision&) {
    if (heard++ == fails_at) throw UserError("no more");
  }
};

// A dense gas commits more than a batch at a time: its observer is called in the middle of a run.
// The error leaves the world at a time that edits, new bodies and the next run can start from.
TEST(Delivery, error_of_an_observer_leaves_the_world_at_its_committed_time) {
  const auto run_on = [](World& world, const std::function<void(World&)>& change) {
    const auto failing = std::make_shared<Failing>();
    failing->fails_at = 10;
    world.add_collision_observer([failing](const Collision& c) { (*failing)(c); });
    EXPECT_THROW(world.advance(1000), UserError);
    EXPECT_LT(world.time(), 1000) << "the error came from the last delivery";
    EXPECT_EQ(world.time(), world.kernel().simulation.present.gvt);
    change(world);
    const double later = world.time() + 0.5;
    EXPECT_NO_THROW(world.advance(later));
    EXPECT_EQ(failing->heard, count_of(world.statistics(), "collisions"));
  };
  World edited, added, gravity;
  for (World* world : {&edited, &added, &gravity}) fill_with_gas(*world);
  run_on(edited, [](World& world) {
    world.edit(10, [](StateView& view) { view.set_velocity({0.5, 0, 0}); });
  });
  run_on(added, [](World& world) {
    BodyDef ghost;
    ghost.mass = 1;
    ghost.inertia = Mat3::Identity();
    ghost.center_of_mass = Vec3::Zero();
    world.add_body(ghost);
  });
  run_on(gravity, [](World& world) { world.set_gravity({0, 0, -1}); });
}

// The first of two throws, at a collision of its own: the second hears of that collision all the
// same, and nobody hears of one twice.
TEST(Delivery, every_observer_hears_of_every_collision_once) {
  for (const long fails_at : {0L, 7L, 100L}) {
    World world;
    fill_with_gas(world);
    Failing first;
    first.fails_at = fails_at;
    std::vector<Key> second;
    world.add_collision_observer([&](const Collision& c) { first(c); });
    world.add_collision_observer([&](const Collision& c) { second.push_back(c.key); });
    EXPECT_THROW(world.advance(3), UserError);
    world.advance(3);
    const auto collisions = count_of(world.statistics(), "collisions");
    EXPECT_EQ(first.heard, collisions);
    EXPECT_EQ(static_cast<std::int64_t>(second.size()), collisions);
    EXPECT_TRUE(std::is_sorted(second.begin(), second.end()));
    EXPECT_EQ(std::unique(second.begin(), second.end()), second.end());
  }
}

// An observer throws while what a callback's error has made final is delivered.  The callback's
// error is mended then; nobody must hear of it any more.
TEST(Delivery, error_that_was_mended_is_not_raised_later) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {2, 0, 0});
  add_ball(world, 0.5, {2, 0, 0}, Vec3::Zero());
  add_callback(world, {a}, 1, 10,
               [](double, std::span<StateView* const> targets) -> std::optional<double> {
                 if (targets[0]->state().velocity.norm() > 0) return std::nullopt;
                 throw UserError("it stands still");
               });
  Failing observer;
  observer.fails_at = 0;
  world.add_collision_observer([&](const Collision& c) { observer(c); });
  EXPECT_THROW(world.advance(2), UserError);
  ASSERT_EQ(observer.heard, 1);
  world.edit(a, [](StateView& view) { view.set_velocity({0, 1, 0}); });
  EXPECT_NO_THROW(world.advance(2));
}

class PoseSink : public FrameSink {
 public:
  void frame(long index, double, std::span<const BodyPose> poses) override {
    indices.push_back(index);
    for (const BodyPose& pose : poses) numbers.push_back(pose.state.position.z());
  }
  std::vector<long> indices;
  std::vector<double> numbers;
};

// Balls that bounce on a floor: whoever is extrapolated from the checkpoint falls through it.
void fill_with_bouncers(World& world) {
  set_contact_for_all(world, 1, 0);
  add_wall(world, Vec3::UnitZ(), 0);
  for (int i = 0; i < 3; ++i) add_ball(world, 0.1, {1.0 * i, 0, 0.5 + 0.3 * i}, Vec3::Zero());
}

// Frames after a restore are those of a run that was never interrupted, none twice and none left
// out, also where the checkpoint lies between frames or at one.
TEST(Delivery, frames_after_a_restore_are_those_of_one_run) {
  for (const double when : {0.0, 0.5, 0.53}) {
    World plain;
    fill_with_bouncers(plain);
    const auto expected = std::make_shared<PoseSink>();
    plain.add_frame_sink(expected, 64);
    plain.advance(2);

    World world;
    fill_with_bouncers(world);
    const auto sink = std::make_shared<PoseSink>();
    world.add_frame_sink(sink, 64);
    if (when > 0) world.advance(when);
    const auto checkpoint = world.checkpoint();
    const PoseSink before = *sink;
    for (const double past : {when + 0.7, 2.0}) {
      world.advance(past);
      world.restore(*checkpoint);
      *sink = before;
    }
    world.advance(2);
    EXPECT_EQ(sink->indices, expected->indices) << "checkpoint at " << when;
    EXPECT_EQ(sink->numbers, expected->numbers) << "checkpoint at " << when;
  }
}

// What an error of an observer had left undelivered is delivered before the checkpoint is made.
TEST(Delivery, checkpoint_leaves_nothing_undelivered) {
  World world;
  fill_with_gas(world);
  Failing observer;
  observer.fails_at = 3;
  world.add_collision_observer([&](const Collision& c) { observer(c); });
  EXPECT_THROW(world.advance(3), UserError);
  ASSERT_GT(KernelTest(world).undelivered(), 0u);
  const auto checkpoint = world.checkpoint();
  EXPECT_EQ(KernelTest(world).undelivered(), 0u);
  EXPECT_EQ(observer.heard, count_of(world.statistics(), "collisions"));
  world.advance(4);
  world.restore(*checkpoint);
  EXPECT_EQ(KernelTest(world).undelivered(), 0u);
}

}  // namespace
}  // namespace tw::test
