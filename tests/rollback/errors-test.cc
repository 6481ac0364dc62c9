// Errors and interrupts: speculative until committed; the world stays usable afterwards.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/callback-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

// a runs into b at 1 s.  b's callback at 1.25 s throws where b was not hit before.
struct Pursuit {
  explicit Pursuit(const Schedule& schedule, double a_speed = 4) {
    apply(world, schedule);
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    a = add_ball(world, 0.5, {0, 0, 0}, {a_speed, 0, 0});
    b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
    add_callback(world, {b}, 1.25, 10,
                 [this](double, std::span<StateView* const> targets) -> std::optional<double> {
                   if (targets[0]->state().velocity.x() > 3) return std::nullopt;
                   ++thrown;
                   throw UserError("b was not hit");
                 });
  }
  World world;
  BodyId a = 0, b = 0;
  int thrown = 0;
};

TEST(Errors, error_that_is_rolled_back_is_never_raised) {
  int thrown = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Pursuit scene(adversary_schedule(seed));
    EXPECT_NO_THROW(scene.world.advance(2)) << "seed " << seed;
    EXPECT_EQ(scene.world.state(scene.b).velocity, Vec3(4, 0, 0));
    thrown += scene.thrown;
  }
  EXPECT_GT(thrown, 10) << "the adversaries never ran the callback too early";
}

TEST(Errors, committed_error_is_raised_and_the_world_goes_on_after_an_edit) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Pursuit scene(adversary_schedule(seed), 1);  // never reaches b
    World& world = scene.world;
    EXPECT_EQ(message_of([&] { world.advance(2); }), "b was not hit") << "seed " << seed;
    EXPECT_LE(world.time(), 1.25);
    EXPECT_FALSE(world.running());
    EXPECT_TRUE(std::isfinite(world.total_energy()));
    // nothing has changed: the same again
    EXPECT_EQ(message_of([&] { world.advance(2); }), "b was not hit");
    world.edit(scene.b, [](StateView& view) { view.set_velocity({3.5, 0, 0}); });
    EXPECT_NO_THROW(world.advance(2));
    EXPECT_EQ(world.time(), 2);
    EXPECT_EQ(world.state(scene.b).velocity, Vec3(3.5, 0, 0));
    EXPECT_EQ(world.state(scene.a).position, Vec3(2, 0, 0));
  }
}

TEST(Errors, runs_that_end_before_an_error_do_not_raise_it) {
  Pursuit scene(Schedule(), 1);
  EXPECT_NO_THROW(scene.world.advance(1));
  EXPECT_NO_THROW(scene.world.advance(1.2499));
  EXPECT_THROW(scene.world.advance(1.25), UserError) << "keys at the end belong to the run";
}

// The first of two errors is raised, also if the later one was found first.
TEST(Errors, the_earliest_error_is_raised_first) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    World world;
    apply(world, adversary_schedule(seed));
    world.set_gravity(Vec3::Zero());
    for (int i = 0; i < 4; ++i) {
      const BodyId ball = add_ball(world, 0.25, {2.0 * i, 0, 0}, {0, 1, 0});
      add_callback(world, {ball}, 2 - 0.25 * i, 10,
                   [i](double, std::span<StateView* const>) -> std::optional<double> {
                     throw UserError("error " + std::to_string(i));
                   });
    }
    EXPECT_EQ(message_of([&] { world.advance(3); }), "error 3") << "seed " << seed;
    EXPECT_LE(world.time(), 1.25);
  }
}

// A collision callback's error stops the two bodies, and others live on until it is final.
TEST(Errors, collision_callback_error_is_speculative_too) {
  int thrown = 0;
  for (std::uint64_t seed = 1; seed < 400; seed += 2) {
    World world;
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 3;
    apply(world, schedule);
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
    const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
    const BodyId c = add_ball(world, 0.5, {8, 0, 0}, {0, 0, 0});
    // b reaches c with 4 m/s, having been hit, or in a history that never was, with 2 m/s
    add_collision_callback(world, [&](const Collision& collision, StateView&, StateView&) {
      if (collision.body1 == b && collision.body2 == c && collision.speed < 3) {
        ++thrown;
        throw UserError("b was slow");
      }
    });
    EXPECT_NO_THROW(world.advance(3)) << "seed " << seed;
    EXPECT_EQ(world.state(c).velocity, Vec3(4, 0, 0));
  }
  EXPECT_GT(thrown, 3) << "the adversaries never processed the late impact first";
}

// Thrown by the n-th call, whatever n is, the run goes on to the same history.
TEST(Errors, interrupts_in_callbacks_leave_no_trace) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    long calls = 0, limit = -1;
    const Scene scene = callback_on_pairs_scene(3, 1.1, 1);
    const auto fill_world = [&](World& world) {
      apply(world, seed == 0 ? Schedule() : adversary_schedule(seed));
      scene.fill(world);
      add_collision_callback(world, [&](const Collision&, StateView& a, StateView&) {
        if (a.slots()) a.set_slots(make_counter(counter_of(a.slots()) + 2));
        if (++calls == limit) throw Interrupted();
      });
      add_callback(world, {6, 7}, 0, 0.0625, [&](double, std::span<StateView* const> targets) {
        targets[0]->draw_random();
        if (++calls == limit) throw Interrupted();
        return std::nullopt;
      });
    };
    World expected;
    fill_world(expected);
    expected.advance(scene.duration);
    const long all = calls;
    EXPECT_GT(all, 16);
    for (limit = 1; limit <= all; limit += 1 + all / 25) {
      calls = 0;
      World world;
      fill_world(world);
      EXPECT_THROW(world.advance(scene.duration), Interrupted);
      EXPECT_FALSE(world.running());
      EXPECT_EQ(world.advance(scene.duration), RunStatus::finished);
      EXPECT_EQ(world.history_hash(), expected.history_hash()) << "call " << limit;
    }
  }
}

// Interrupts and errors in observers and sinks: nothing is told twice, nothing is lost.
TEST(Errors, failing_observers_and_sinks_lose_and_repeat_nothing) {
  class Sink : public FrameSink {
   public:
    void frame(long index, double, std::span<const BodyPose>) override {
      EXPECT_EQ(index, count);
      ++count;
      if (index % 7 == 3) throw Interrupted();
    }
    long count = 0;
  };
  const Scene scene = lattice_scene(4, 1, 2);
  const Outcome expected = run(scene, Schedule());
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    World world;
    apply(world, seed == 0 ? Schedule() : adversary_schedule(seed));
    scene.fill(world);
    std::vector<Key> keys;
    world.add_collision_observer([&](const Collision& c) {
      if (!keys.empty()) {
        EXPECT_LT(keys.back(), c.key);
      }
      keys.push_back(c.key);
      if (keys.size() % 10 == 5) throw UserError("no more room");
    });
    const auto sink = std::make_shared<Sink>();
    world.add_frame_sink(sink, 30);
    int failures = 0;
    for (bool done = false; !done && failures < 1000;) {
      try {
        done = world.advance(scene.duration) == RunStatus::finished;
      } catch (const std::exception&) {
        ++failures;
      }
    }
    EXPECT_GT(failures, 10);
    EXPECT_EQ(static_cast<std::int64_t>(keys.size()), expected.collisions);
    EXPECT_EQ(sink->count, 61);
    EXPECT_EQ(world.history_hash(), expected.hash);
  }
}

TEST(Errors, callbacks_may_not_change_the_world) {
  World world;
  world.set_gravity(Vec3::Zero());
  const BodyId ball = add_ball(world, 0.25, Vec3::Zero(), {1, 0, 0});
  std::vector<std::function<void()>> forbidden = {
      [&] { world.advance(5); },
      [&] { world.step(5); },
      [&] { world.edit(ball, [](StateView&) {}); },
      [&] { world.set_gravity(Vec3::Zero()); },
      [&] { set_contact_for_all(world, 1, 0); },
      [&] {
        add_ball(world, 0.25, {9, 0, 0}, Vec3::Zero());
      },
      [&] { world.add_collision_observer([](const Collision&) {}); },
  };
  std::size_t refused = 0;
  add_callback(world, {ball}, 0.5, 0.5, [&](double, std::span<StateView* const>) {
    for (const auto& action : forbidden) {
      try {
        action();
      } catch (const UserError&) {
        ++refused;
      }
    }
    return std::nullopt;
  });
  world.advance(0.75);
  EXPECT_EQ(refused, forbidden.size());
  EXPECT_EQ(world.time(), 0.75);
}

}  // namespace
}  // namespace tw::test
