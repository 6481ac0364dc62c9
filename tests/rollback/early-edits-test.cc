// Edits where what happens at the present time is still to come: after a callback's error, after an
// interrupt.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/callback-scenes.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// A callback that fails until somebody makes the ball move.
BodyId add_fussy_ball(World& world, double start) {
  world.set_gravity(Vec3::Zero());
  const BodyId ball = add_ball(world, 0.5, Vec3::Zero(), Vec3::Zero());
  add_callback(world, {ball}, start, 10, [](double, std::span<StateView* const> targets) {
    if (targets[0]->state().velocity.isZero()) throw UserError("it stands still");
    targets[0]->set_velocity(targets[0]->state().velocity + Vec3(0, 1, 0));
    return std::optional<double>();
  });
  return ball;
}

// An edit that mends nothing leaves the error, and one that mends it is seen by the callback, which
// runs again.
TEST(EarlyEdits, come_before_the_callback_that_stopped_the_run) {
  for (const double start : {0.0, 0.25})
    for (const bool undo_redo : {false, true}) {
      World world;
      world.set_check(true);
      world.set_undo_redo(undo_redo);
      const BodyId ball = add_fussy_ball(world, start);
      EXPECT_THROW(world.advance(1), UserError);
      EXPECT_EQ(world.time(), start);
      world.edit(ball, [](StateView& view) { view.set_angular_velocity({0, 0, 1}); });
      EXPECT_THROW(world.advance(1), UserError) << "the edit hid the error";
      EXPECT_EQ(world.state(ball).angular_velocity, Vec3(0, 0, 1));
      world.edit(ball, [](StateView& view) { view.set_velocity({2, 0, 0}); });
      EXPECT_EQ(world.state(ball).velocity, Vec3(2, 0, 0));
      EXPECT_NO_THROW(world.advance(1));
      EXPECT_EQ(world.state(ball).velocity, Vec3(2, 1, 0));
      EXPECT_EQ(world.state(ball).angular_velocity, Vec3(0, 0, 1));
    }
}

// The same from a checkpoint made in between: the edit and the tick that is due are part of it.
TEST(EarlyEdits, are_part_of_a_checkpoint) {
  World world, plain;
  std::string hash;
  for (World* w : {&plain, &world}) {
    w->set_hash(true);
    const BodyId ball = add_fussy_ball(*w, 0.25);
    EXPECT_THROW(w->advance(1), UserError);
    w->edit(ball, [](StateView& view) { view.set_velocity({2, 0, 0}); });
    if (w == &world) {
      const auto checkpoint = w->checkpoint();
      w->advance(2);
      w->restore(*checkpoint);
    }
    w->advance(1);
    EXPECT_EQ(w->state(ball).velocity, Vec3(2, 1, 0));
  }
  EXPECT_EQ(world.history_hash(), plain.history_hash());
}

// An interrupted run stops where the next event is due: an edit there must outlast that event.
TEST(EarlyEdits, made_where_an_event_is_due_are_not_lost) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {1, 0, 0});
  const BodyId b = add_ball(world, 0.5, {2, 0, 0}, Vec3::Zero());
  struct Stop : Callback {
    bool armed = true;
    std::optional<double> run(double, std::span<StateView* const>) override {
      if (std::exchange(armed, false)) throw Interrupted();
      return std::nullopt;
    }
  };
  CallbackDef stop;
  stop.targets = {a};
  stop.callback = std::make_shared<Stop>();
  stop.start = 0.5;
  stop.period = 10;
  world.add_callback(stop);
  EXPECT_THROW(world.advance(3), Interrupted);
  while (world.time() < 0.5) world.step();
  ASSERT_EQ(world.time(), 0.5);
  world.edit(a, [](StateView& view) { view.set_velocity({0, 1, 0}); });
  world.advance(3);
  EXPECT_EQ(world.state(a).velocity, Vec3(0, 1, 0));
  EXPECT_EQ(world.state(b).velocity, Vec3::Zero());
}

// In a heap, at an instant at which a group check is due.
TEST(EarlyEdits, of_a_member_of_a_group_hold) {
  World world;
  world.set_check(true);
  set_contact_for_all(world, 0.2, 0.5);
  add_block(world, {10, 10, 1}, {0, 0, -0.5});
  std::vector<BodyId> boxes;
  for (int i = 0; i < 3; ++i)
    boxes.push_back(add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.1 + 0.2 * i}));
  bool armed = true;
  add_callback(world, {boxes[1]}, 1 / 480.0 * 32, 10, [&](double, std::span<StateView* const>) {
    if (std::exchange(armed, false)) throw UserError("once");
    return std::optional<double>();
  });
  EXPECT_THROW(world.advance(1), UserError);
  world.edit(boxes[2], [](StateView& view) { view.set_velocity({0, 0, 3}); });
  world.advance(0.2);
  EXPECT_GT(world.state(boxes[2]).position.z(), 0.7);
}

}  // namespace
}  // namespace tw::test
