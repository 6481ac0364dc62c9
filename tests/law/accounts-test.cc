// The books: work of kinematic bodies through contacts, and the deepest penetration, beside what is
// measured without asking the contacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/heap-scenes.h"
#include "support/stability.h"

namespace tw::test {
namespace {

BodyId add_platform(World& world, std::vector<Keyframe> frames, bool smooth) {
  BodyDef platform;
  platform.shape = make_box({4, 4, 0.2});
  platform.motion = make_keyframes(std::move(frames), smooth);
  return world.add_body(platform);
}

// Energy at the end less that at the start and the work of kinematic bodies: minus what was lost on
// the way.
double gain_beyond_work(const World& world) {
  const auto table = world.statistics();
  return number_of(table, "energy_end") - number_of(table, "energy_start") -
         number_of(table, "kinematic_work");
}

// A box of 64 kg is carried up by 1 m and 0.5 m aside: m g h, and nothing beside.  The work is
// known to 2e-5 of it.
TEST(KinematicWork, of_a_lift_is_the_weight_times_the_way) {
  World world;
  set_contact_for_all(world, 0, 0.6);
  add_platform(world, {{0.5, {0, 0, -0.1}, {}}, {2.5, {0.5, 0, 0.9}, {}}}, true);
  const BodyId box = add_box(world, {0.4, 0.4, 0.4}, {0, 0, 0.2});
  world.advance(3);
  const double mg = world.body(box).mass * 9.81;
  EXPECT_NEAR(world.state(box).position.z(), 1.2, 1e-3);
  const double work = number_of(world.statistics(), "kinematic_work");
  EXPECT_NEAR(work, mg, 2e-4 * mg);
  EXPECT_NEAR(gain_beyond_work(world), 0, 2e-5 * mg);
}

// A box put on a belt that runs at v is brought to v: half of the work is its kinetic energy, the
// other half is lost in sliding.
TEST(KinematicWork, of_a_belt_is_twice_the_energy_it_gives) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  constexpr double v = 1;
  add_platform(world, {{-10, {-10 * v, 0, -0.1}, {}}, {10, {10 * v, 0, -0.1}, {}}}, false);
  const BodyId box = add_box(world, {0.4, 0.4, 0.2}, {0, 0, 0.1});
  world.advance(1);
  EXPECT_NEAR(world.state(box).velocity.x(), v, 1e-6);
  const double mass = world.body(box).mass;
  const double work = number_of(world.statistics(), "kinematic_work");
  EXPECT_NEAR(work, mass * v * v, 2e-3 * mass * v * v);
}

// Likewise a ball in the middle of a turntable, which spinning friction alone brings to its w.
TEST(KinematicWork, of_a_turntable_is_twice_the_energy_it_gives) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  ContactSettings settings;
  settings.spinning_friction = 0.01;
  world.set_contact({}, {}, settings);
  constexpr double w = 5;
  std::vector<Keyframe> frames;
  for (double time = -1; time <= 4; time += 0.1)
    frames.push_back({time, {0, 0, -0.1}, rotation_by(Vec3(0, 0, w * time))});
  add_platform(world, frames, false);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, Vec3::Zero());
  world.advance(3);
  EXPECT_NEAR(world.state(ball).angular_velocity.z(), w, 1e-6);
  const double energy = 0.5 * 0.4 * world.body(ball).mass * 0.01 * w * w;
  const double work = number_of(world.statistics(), "kinematic_work");
  EXPECT_NEAR(work, 2 * energy, 2e-3 * 2 * energy);
}

// A box that sticks to a tray which is lifted and rocked about a slanting axis: all comes back but
// what the springs' dampers take, 0.007 J of 56 J at an accuracy of 1e-9.  Here its error is that
// of the steps; without the torque that they know of it was 0.08 J.
TEST(KinematicWork, of_a_rocked_tray_is_given_back) {
  World world;
  set_contact_for_all(world, 0, 1);
  const Quat tilted = rotation_by(0.4 * Vec3(0.6, 0.8, 0));
  add_platform(world,
               {{0.5, {0, 0, -0.1}, {}}, {1.5, {0.1, 0, 0.1}, tilted}, {2.5, {0, 0, -0.1}, {}}},
               true);
  add_box(world, {0.4, 0.4, 0.4}, {1, 0.2, 0.2});
  double most = 0;
  for (const double time : {1.0, 1.5, 2.0, 3.0}) {
    world.advance(time);
    most = std::max(most, std::abs(number_of(world.statistics(), "kinematic_work")));
    EXPECT_NEAR(gain_beyond_work(world), -0.007, 0.01) << time;
  }
  EXPECT_GT(most, 50);
}

// A shaken tray with boxes, balls and rocks: whatever they have was given to them.
TEST(KinematicWork, balances_on_a_shaken_platform_at_every_time) {
  World world;
  platform_scene(0).fill(world);
  double best = 0, worst = 0;
  const double unit = number_of(world.statistics(), "energy_start") + 1;
  for (int i = 1; i <= 60; ++i) {
    world.advance(i / 40.0);
    const double gain = gain_beyond_work(world);
    EXPECT_LE(gain, best + 2e-4 * unit) << world.time();
    best = std::min(best, gain);
    worst = std::max(worst, std::abs(number_of(world.statistics(), "kinematic_work")));
  }
  EXPECT_GT(worst, 0.1 * unit) << "nothing was moved";
}

// A row of boxes on a lift, struck at one end by a box that slides: those that do not feel it keep
// their arcs, whose first states are committed before the arcs end.
TEST(KinematicWork, does_not_depend_on_when_states_are_committed) {
  const auto work_in = [](int pieces) {
    World world;
    set_contact_for_all(world, 0, 0.5);
    BodyDef lift;
    lift.shape = make_box({40, 4, 0.2});
    lift.motion = make_keyframes({{0, {0, 0, -0.1}, {}}, {4, {0, 0, 3.9}, {}}}, false);
    world.add_body(lift);
    for (int i = 0; i < 16; ++i) add_box(world, {0.4, 0.4, 0.4}, {0.4 * i, 0, 0.2});
    BodyDef striker = body_of(make_box({0.4, 0.4, 0.4}), {-0.7, 0, 0.2}, {3, 0, 1});
    world.add_body(striker);
    for (int i = 1; i <= pieces; ++i) world.advance(0.5 * i / pieces);
    return number_of(world.statistics(), "kinematic_work");
  };
  const double whole = work_in(1);
  EXPECT_GT(whole, 1000);
  for (const int pieces : {7, 100, 1000})
    EXPECT_NEAR(work_in(pieces), whole, 1e-6 * whole) << pieces;
}

// Frames are looked at, too: a sink that wants 200 a second and does nothing with them.
void look_at_frames(World& world) {
  class Sink : public FrameSink {
    void frame(long, double, std::span<const BodyPose>) override {}
  };
  world.add_frame_sink(std::make_shared<Sink>(), 200);
}

// The deepest overlap that distance queries on the poses see, over samples, m.
class Judge {
 public:
  void look(const World& world) {
    StabilityOutcome outcome;
    measure_depths(world, outcome);
    deepest_ = std::max(deepest_, outcome.deepest);
  }
  double deepest() const { return deepest_; }

 private:
  double deepest_ = 0;
};

double max_penetration(const World& world) {
  return number_of(world.statistics(), "max_penetration");
}

TEST(MaxPenetration, of_a_stack_is_the_depth_of_its_lowest_contact) {
  World world;
  set_contact_for_all(world, 0.2, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  // let down by 1e-5 m each: what is placed touching would not sink
  for (int i = 0; i < 10; ++i) add_box(world, {1, 1, 1}, {0, 0, 0.5 + i + 1e-5 * (i + 1)});
  look_at_frames(world);
  Judge owner, at_rest;
  for (int i = 1; i <= 400; ++i) {
    world.advance(i / 200.0);
    owner.look(world);
  }
  at_rest.look(world);
  EXPECT_NEAR(at_rest.deepest(), 7.6e-4, 1e-5);
  EXPECT_GT(owner.deepest(), at_rest.deepest()) << "deeper while the weight came on";
  EXPECT_NEAR(max_penetration(world), owner.deepest(), 1e-3 * owner.deepest());
}

TEST(MaxPenetration, of_a_heap_is_what_a_judge_sees) {
  World world;
  heap_scene(20, 0).fill(world);
  look_at_frames(world);
  Judge owner;
  for (int i = 1; i <= 150; ++i) {
    world.advance(0.01 * i);
    owner.look(world);
  }
  EXPECT_GE(max_penetration(world), 0.99 * owner.deepest());
  EXPECT_LE(max_penetration(world), 1.5 * owner.deepest());
}

// It is that of the committed history: no schedule changes it.
TEST(MaxPenetration, does_not_depend_on_the_schedule) {
  const auto measured = [](const Schedule& schedule) {
    World world;
    apply(world, schedule);
    tower_scene(6, 0).fill(world);
    world.advance(1);
    return max_penetration(world);
  };
  const double expected = measured(Schedule());
  EXPECT_GT(expected, 1e-5);
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 0.05;
    EXPECT_EQ(measured(schedule), expected) << seed;
  }
}

}  // namespace
}  // namespace tw::test
