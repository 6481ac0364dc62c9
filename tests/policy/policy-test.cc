// Policies of every kind that the interface can express commit the same history: the schedule never
// changes the answer.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/policy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/callback-scenes.h"
#include "support/heap-scenes.h"
#include "support/multibody-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// Timewarp but for what a test changes, counting what it decided.
class Toy : public Policy {
 public:
  std::string name() const override { return "toy"; }
  const Event& next(const EventQueue& queue) override { return queue.top(); }
  double may_reach(const EventQueue&, const Process&) override { return never; }
  void widen(RollbackScope&, const Key&) override {}
  long decisions = 0;
};

// Conservative advancement: nobody goes past the next check of anybody.
struct LeastCheck : Toy {
  double may_reach(const EventQueue& queue, const Process& process) override {
    double least = never;
    for (const EventQueue::Handle handle : queue.handles())
      if (queue.event(handle).kind == EventKind::pair)
        least = std::min(least, queue.event(handle).key.time);
    decisions += process.claim.time < least && least < never;
    return least;
  }
};

// Nobody goes farther than a step at a time: as where arcs are made of steps.
struct Steps : Toy {
  double may_reach(const EventQueue&, const Process& process) override {
    ++decisions;
    return process.claim.time + 0.01;
  }
};

// Retroactive detection: everybody is rolled back to each discontinuity.
struct Everybody : Toy {
  void widen(RollbackScope& scope, const Key&) override {
    ++decisions;
    scope.add_all();
  }
};

struct StepsOfEverybody : Steps {
  void widen(RollbackScope& scope, const Key&) override { scope.add_all(); }
};

// The last event of the next tenth of a second first: as far out of order as that allows.
struct Backwards : Toy {
  const Event& next(const EventQueue& queue) override {
    EventQueue::Handle last = EventQueue::none;
    for (const EventQueue::Handle handle : queue.handles())
      if (queue.event(handle).priority <= queue.top_priority() + 0.1 &&
          (last == EventQueue::none || queue.event(last).key < queue.event(handle).key))
        last = handle;
    decisions += queue.event(last).key != queue.top().key;
    return queue.event(last);
  }
};

// Every other time only: where each event takes all later ones back, last first is exponential.
struct BackwardsForEverybody : Backwards {
  const Event& next(const EventQueue& queue) override {
    in_order_ = !in_order_;
    return in_order_ ? queue.top() : Backwards::next(queue);
  }
  void widen(RollbackScope& scope, const Key&) override { scope.add_all(); }

 private:
  bool in_order_ = false;
};

struct Finished {
  std::string hash;
  std::int64_t collisions = 0, claims = 0, removed = 0;
  long decisions = 0;
};

// (without the decisions, which only toys count)
Finished run_with(std::unique_ptr<Policy> policy, const Scene& scene, World& world) {
  Schedule schedule;
  schedule.check = true;
  apply(world, schedule);
  world.set_policy(std::move(policy));
  scene.fill(world);
  advance_in_pieces(world, scene.duration, 2);
  const StatisticsTable table = world.statistics();
  return {world.history_hash(), count_of(table, "collisions"), count_of(table, "claims"),
          count_of(table, "states_rolled_back"), 0};
}

Finished run_under(const std::string& policy, const Scene& scene) {
  World world;
  return run_with(make_policy(policy), scene, world);
}

// Cubes that turn, in a box without gravity; no two impacts at one time.
Scene tumbling_cubes(double duration) {
  const auto fill_world = [](World& world) {
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    add_walls(world, -0.9, 2.7);
    for (int i = 0; i < 8; ++i) {
      BodyDef cube = body_of(make_box({0.5, 0.5, 0.5}), 1.8 * Vec3(i & 1, i >> 1 & 1, i >> 2),
                             2 * Vec3(std::sin(3 * i + 1), std::sin(5 * i + 2), std::cos(7 * i)));
      cube.angular_velocity = 2 * Vec3(std::cos(2 * i), std::sin(4 * i), 1);
      world.add_body(cube);
    }
  };
  return {"tumbling cubes", duration, fill_world};
}

// Who struck whom, and when, by Cash and Karp's method.
struct Impacts {
  std::vector<std::pair<BodyId, BodyId>> partners;
  std::vector<double> times;  // s
};

Impacts impacts_under(const std::string& policy, const Scene& scene) {
  World world;
  world.set_integrator("rk45");
  world.set_accuracy(1e-10);
  world.set_policy(policy);
  Impacts impacts;
  world.add_collision_observer([&](const Collision& collision) {
    impacts.partners.emplace_back(collision.body1, collision.body2);
    impacts.times.push_back(collision.time);
  });
  scene.fill(world);
  world.advance(scene.duration);
  return impacts;
}

// Of a moving body: what was integrated, and in what steps, s.
struct Integrated {
  double length = 0, step = 0;
};

Integrated integrated_under(const std::string& policy, const Scene& scene) {
  World world;
  world.set_integrator("rk45");
  world.set_policy(policy);
  scene.fill(world);
  world.advance(scene.duration);
  const StatisticsTable table = world.statistics();
  return {number_of(table, "integration_per_moving_body"),
          number_of(table, "avg_integration_step")};
}

template <class Chosen>
Finished run_under(const Scene& scene) {
  World world;
  auto policy = std::make_unique<Chosen>();
  const Toy* toy = policy.get();
  Finished finished = run_with(std::move(policy), scene, world);
  finished.decisions = toy->decisions;
  return finished;
}

// A chain that falls from its hinge onto a floor where a ball rolls.
Scene chain_scene(double duration) {
  const auto fill_world = [](World& world) {
    add_floor(world);
    world.add_multibody(chain(4, 0.3, {0, 0, 1}));
    add_ball(world, 0.1, {0.5, 0, 0.3}, {0, 0.1, 0});
  };
  return {"chain", duration, fill_world};
}

// Exact pairs, pairs on the grid, callbacks, contact groups, a multibody.
std::vector<Scene> scenes() {
  return {lattice_scene(3, 1.1, 2),           cube_lattice_scene(2, 1.1, 1), floor_scene(0.6),
          callback_on_pairs_scene(3, 1.1, 1), tower_scene(3, 0.7),           chain_scene(0.8)};
}

template <class Chosen>
void expect_same_history() {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Finished expected = run_under<Toy>(scene);
    const Finished run = run_under<Chosen>(scene);
    EXPECT_EQ(run.hash, expected.hash);
    EXPECT_EQ(run.collisions, expected.collisions);
    EXPECT_GT(run.decisions, 0) << "the policy was not asked";
    std::printf("  %-24s %4ld collisions, claims %6ld -> %6ld, states removed %5ld -> %5ld\n",
                scene.name.c_str(), static_cast<long>(run.collisions),
                static_cast<long>(expected.claims), static_cast<long>(run.claims),
                static_cast<long>(expected.removed), static_cast<long>(run.removed));
  }
}

TEST(Policy, nobody_past_the_least_check_gives_the_same_history) {
  expect_same_history<LeastCheck>();
}
TEST(Policy, steps_give_the_same_history) { expect_same_history<Steps>(); }
TEST(Policy, rollback_of_everybody_gives_the_same_history) { expect_same_history<Everybody>(); }
TEST(Policy, steps_and_rollback_of_everybody_give_the_same_history) {
  expect_same_history<StepsOfEverybody>();
}
TEST(Policy, backwards_gives_the_same_history) { expect_same_history<Backwards>(); }
TEST(Policy, backwards_and_rollback_of_everybody_give_the_same_history) {
  expect_same_history<BackwardsForEverybody>();
}

// The test that the hooks do what they say: bounded windows are more, rolled back claims are, too.
TEST(Policy, what_it_decides_is_done) {
  const Scene scene = floor_scene(0.6);
  const Finished timewarp = run_under<Toy>(scene);
  EXPECT_GT(run_under<LeastCheck>(scene).claims, 2 * timewarp.claims);
  EXPECT_GT(run_under<Steps>(scene).claims, 2 * timewarp.claims);
  EXPECT_GT(run_under<Everybody>(scene).claims, 2 * timewarp.claims);
  EXPECT_GT(run_under<Backwards>(scene).removed, timewarp.removed);
}

// The paper's loops (sections 2.1 and 2.2), as users get them: where nothing is integrated the
// history is timewarp's, bit for bit.
TEST(Policy, those_of_the_paper_give_the_same_history) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Finished expected = run_under("timewarp", scene);
    for (const char* name : {"conservative", "retroactive:0.001", "retroactive:0.0333"}) {
      SCOPED_TRACE(name);
      const Finished run = run_under(name, scene);
      EXPECT_EQ(run.hash, expected.hash);
      EXPECT_GT(run.claims, expected.claims);
    }
  }
}

// With a method of steps they stop where all stand at the same time, and agree to its tolerance:
// the same impacts in the same order, until chaos takes over.
TEST(Policy, those_of_the_paper_agree_with_steps) {
  const Scene scene = tumbling_cubes(1.6);
  const Impacts expected = impacts_under("timewarp", scene);
  ASSERT_GT(expected.partners.size(), 8u);
  for (const char* name : {"conservative", "retroactive:0.001", "retroactive:0.0333"}) {
    SCOPED_TRACE(name);
    const Impacts run = impacts_under(name, scene);
    ASSERT_EQ(run.partners, expected.partners);
    for (std::size_t i = 0; i < run.times.size(); ++i)
      EXPECT_NEAR(run.times[i], expected.times[i], 1e-6) << i;
  }
}

// What the paper compares them by (figure 6): conservative advancement never integrates in vain,
// but in small steps; retroactive detection wastes more, the longer its step.
TEST(Policy, cost_what_the_paper_says) {
  const Scene scene = cube_lattice_scene(2, 1.1, 1);
  const Integrated timewarp = integrated_under("timewarp", scene);
  const Integrated conservative = integrated_under("conservative", scene);
  const Integrated fine = integrated_under("retroactive:0.001", scene);
  const Integrated coarse = integrated_under("retroactive:0.0333", scene);
  EXPECT_LT(conservative.length, 1.01 * scene.duration);
  EXPECT_GT(coarse.length, 1.1 * scene.duration);
  EXPECT_GT(coarse.length, fine.length);
  EXPECT_LT(fine.step, coarse.step);
  EXPECT_LT(conservative.step, timewarp.step);
}

TEST(Policy, are_checked) {
  World world;
  for (const char* good : {"conservative", "retroactive:0.01", "timewarp"})
    EXPECT_NO_THROW(world.set_policy(good));
  for (const char* bad : {"retroactive", "retroactive:", "retroactive:0", "retroactive:x",
                          "retroactive:1s", "retroactive:inf", "eager", ""})
    EXPECT_THROW(world.set_policy(bad), UserError) << bad;
  world.advance(1);
  EXPECT_THROW(world.set_policy(std::make_unique<Toy>()), UserError);
}

}  // namespace
}  // namespace tw::test
