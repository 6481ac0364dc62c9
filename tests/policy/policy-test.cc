// Policies of every kind that the interface can express commit the same history: the schedule never
// changes the answer.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/policy.h"

#include <gtest/gtest.h>

#include "support/callback-scenes.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// Timewarp but for what a test changes, counting what it decided.
class Toy : public Policy {
 public:
  const char* name() const override { return "toy"; }
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

template <class Chosen>
Finished run_under(const Scene& scene) {
  World world;
  Schedule schedule;
  schedule.check = true;
  apply(world, schedule);
  auto policy = std::make_unique<Chosen>();
  const Toy* toy = policy.get();
  world.set_policy(std::move(policy));
  scene.fill(world);
  advance_in_pieces(world, scene.duration, 2);
  const StatisticsTable table = world.statistics();
  return {world.history_hash(), count_of(table, "collisions"), count_of(table, "claims"),
          count_of(table, "states_rolled_back"), toy->decisions};
}

// Exact pairs, pairs on the grid, callbacks, contact groups.
std::vector<Scene> scenes() {
  return {lattice_scene(3, 1.1, 2), cube_lattice_scene(2, 1.1, 1), floor_scene(0.6),
          callback_on_pairs_scene(3, 1.1, 1), tower_scene(3, 0.7)};
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

TEST(Policy, only_timewarp_is_offered) {
  World world;
  EXPECT_NO_THROW(world.set_policy("timewarp"));
  EXPECT_THROW(world.set_policy("retroactive:0.01"), UserError);
  EXPECT_THROW(world.set_policy("conservative"), UserError);
  world.advance(1);
  EXPECT_THROW(world.set_policy(std::make_unique<Toy>()), UserError);
}

}  // namespace
}  // namespace tw::test
