// What users see of a run that was rolled back many times: counters, random numbers, observers,
// frames, states before GVT.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>

#include "kernel/loop/kernel.h"
#include "support/callback-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

constexpr std::uint64_t seeds = 30;

// A counter slot incremented in a collision callback: each committed collision adds one to both
// balls, or to the ball that met a wall; the callback itself ran more often than that.
TEST(Committed, counter_slots_equal_the_number_of_committed_collisions) {
  std::int64_t calls_beyond = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    World world;
    apply(world, adversary_schedule(seed));
    const auto balls = add_counting_lattice(world, 4, 1.1);
    std::map<BodyId, long> observed;
    long calls = 0;
    add_collision_callback(world, [&](const Collision&, StateView&, StateView&) { ++calls; });
    world.add_collision_observer([&](const Collision& c) {
      ++observed[c.body1];
      ++observed[c.body2];
    });
    world.advance(3);
    long sum = 0;
    for (const BodyId ball : balls) {
      EXPECT_EQ(counter_of(world.slots(ball)), observed[ball]) << "seed " << seed;
      sum += counter_of(world.slots(ball));
    }
    EXPECT_GT(sum, 200);
    calls_beyond += calls - count_of(world.statistics(), "collisions");
  }
  EXPECT_GT(calls_beyond, 100) << "no callback was ever rolled back";
}

// The generator in a state: every ball draws at each of its callbacks, some of which are undone.
TEST(Committed, random_generators_roll_back) {
  const auto draws_after = [](const Schedule& schedule, long& calls) {
    World world;
    apply(world, schedule);
    const auto balls = add_counting_lattice(world, 3, 1.1);
    for (std::size_t i = 0; i + 1 < balls.size(); ++i)
      add_callback(world, {balls[i], balls[i + 1]}, 0.1, 0.1,
                   [&calls](double, std::span<StateView* const> targets) {
                     ++calls;
                     if (counter_of(targets[1]->slots()) % 2) targets[0]->draw_random();
                     return std::nullopt;
                   });
    world.advance(2);
    std::vector<double> draws;
    for (const BodyId ball : balls)
      world.edit(ball, [&](StateView& view) { draws.push_back(view.draw_random()); });
    return draws;
  };
  long calls_in_order = 0, calls = 0;
  const std::vector<double> expected = draws_after(Schedule(), calls_in_order);
  const std::uint64_t runs = long_tests() ? seeds : 8;
  for (std::uint64_t seed = 0; seed < runs; ++seed)
    EXPECT_EQ(draws_after(adversary_schedule(seed), calls), expected) << "seed " << seed;
  EXPECT_GT(calls, static_cast<long>(runs) * calls_in_order + 100) << "nothing was undone";
}

TEST(Committed, every_body_has_a_random_stream_of_its_own_from_the_seed) {
  const auto draws = [](std::uint64_t seed) {
    World world;
    world.set_seed(seed);
    std::vector<double> result;
    for (int i = 0; i < 3; ++i) {
      const BodyId ball = add_ball(world, 0.1, {1.0 * i, 0, 0}, Vec3::Zero());
      world.edit(ball, [&](StateView& view) {
        result.push_back(view.draw_random());
        result.push_back(view.draw_random());
      });
    }
    std::vector<double> sorted = result;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
    for (const double x : result) EXPECT_TRUE(x >= 0 && x < 1);
    return result;
  };
  EXPECT_EQ(draws(1), draws(1));
  EXPECT_NE(draws(1), draws(2));
}

// An observer is told of each committed collision once, in time order, whatever happened on the
// way.
TEST(Committed, observers_are_told_once_and_in_time_order) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    World world;
    apply(world, adversary_schedule(seed));
    lattice_scene(4, 1, 3).fill(world);
    std::vector<Key> keys;
    world.add_collision_observer([&](const Collision& c) {
      EXPECT_EQ(c.key.time, c.time);
      EXPECT_LT(c.body1, c.body2);
      EXPECT_GT(c.speed, 0);
      EXPECT_GT(c.impulse, 0);
      EXPECT_LE(c.time, 3);
      if (!keys.empty()) {
        EXPECT_LT(keys.back(), c.key);
      }
      keys.push_back(c.key);
    });
    advance_in_pieces(world, 3, 3);
    EXPECT_EQ(static_cast<std::int64_t>(keys.size()), count_of(world.statistics(), "collisions"));
  }
}

// Observers and sinks see one line of time: no frame after a later collision.
TEST(Committed, frames_and_collisions_are_told_in_one_order) {
  class Sink : public FrameSink {
   public:
    explicit Sink(double& now) : now_(now) {}
    void frame(long index, double frame_time, std::span<const BodyPose> poses) override {
      EXPECT_EQ(index, count++);
      EXPECT_EQ(frame_time, static_cast<double>(index) / 32);
      EXPECT_GE(frame_time, now_);
      EXPECT_EQ(poses.size(), 64u);
      now_ = frame_time;
    }
    long count = 0;

   private:
    double& now_;
  };
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    World world;
    apply(world, adversary_schedule(seed));
    lattice_scene(4, 1, 3).fill(world);
    double now = 0;
    world.add_collision_observer([&](const Collision& c) {
      EXPECT_GE(c.time, now);
      now = c.time;
    });
    const auto sink = std::make_shared<Sink>(now);
    world.add_frame_sink(sink, 32);
    advance_in_pieces(world, 3, 4);
    EXPECT_EQ(sink->count, 97) << "frames 0 to 96, both ends of the run included";
  }
}

// GVT never falls, and a committed state never changes nor goes before GVT has passed its
// successor.
TEST(Committed, nothing_before_gvt_is_touched) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    World world;
    Schedule schedule = adversary_schedule(seed);
    schedule.gvt_interval = 1;
    apply(world, schedule);
    callback_on_pairs_scene(3, 1, 2).fill(world);
    std::map<std::pair<BodyId, double>, Vec3> committed;
    double gvt = 0;
    while (world.step(2)) {
      ASSERT_GE(world.kernel().simulation.present.gvt, gvt);
      gvt = world.kernel().simulation.present.gvt;
      for (BodyId id = 0; id < world.body_count(); ++id)
        for (const QueuedState& s : world.state_queue(id)) {
          if (s.key.time < gvt) {
            ASSERT_TRUE(s.committed) << "seed " << seed << ", " << show(s.key);
          }
          if (!s.committed) continue;
          const auto [known, fresh] =
              committed.insert({{id, s.key.time + 1e-9 * s.key.microstep}, s.state.velocity});
          if (!fresh && s.key.kind == KeyKind::impact) {
            ASSERT_EQ(known->second, s.state.velocity) << "seed " << seed << ", " << show(s.key);
          }
        }
    }
    EXPECT_GT(gvt, 1.9);
    EXPECT_GT(committed.size(), 100u);
  }
}

// States are freed as GVT passes: as many after 100 times the collisions.
TEST(Committed, memory_is_bounded) {
  World world;
  set_contact_for_all(world, 1, 0);
  world.set_gravity(Vec3::Zero());
  add_walls(world, 0, 6);
  Random random(3);
  for (int k = 0; k < 64; ++k)
    add_ball(world, 0.25, 1.5 * Vec3(k % 4, k / 4 % 4, k / 16) + Vec3::Constant(0.75),
             random_vector(random, 4));
  const std::int64_t few = 2000, many = long_tests() ? 1000000 : 100000;
  const auto collisions = [&] { return count_of(world.statistics(), "collisions"); };
  while (collisions() < few) world.advance(world.time() + 0.5);
  const std::int64_t states = count_of(world.statistics(), "peak_states");
  const std::size_t pairs = world.kernel().pairs.size();
  while (collisions() < many) world.advance(world.time() + 20);
  EXPECT_LE(count_of(world.statistics(), "peak_states"), 2 * states);
  EXPECT_LE(world.kernel().pairs.size(), 2 * pairs);
  EXPECT_LE(world.kernel().simulation.graph.state_count(), 300u);
  RecordProperty("peak_states", static_cast<int>(count_of(world.statistics(), "peak_states")));
}

// The same where every body has a callback and under an adversary.
TEST(Committed, memory_is_bounded_with_callbacks_and_rollbacks) {
  World world;
  apply(world, adversary_schedule(7));
  callback_without_period_scene(3, 1.1, 0).fill(world);
  world.advance(20);
  const std::int64_t states = count_of(world.statistics(), "peak_states");
  world.advance(long_tests() ? 2000 : 200);
  EXPECT_LE(count_of(world.statistics(), "peak_states"), 3 * states);
  EXPECT_LE(world.kernel().simulation.graph.state_count(), 400u);
}

}  // namespace
}  // namespace tw::test
