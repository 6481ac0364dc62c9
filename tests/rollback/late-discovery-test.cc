// What is found late: checks that start in the past of one body, and rollbacks step by step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "rollback/kernel-access.h"
#include "support/counter.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// Figure 5 of the paper: a has claimed 3 s of its way along y.  b comes along x and has claimed
// less. When a claim of b makes the boxes overlap, the check starts at b's claimed time before that
// claim - the lesser of the two, in a's past - and finds the impact there.
class Figure5 : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    world_.set_gravity(Vec3::Zero());
    world_.set_check(true);
    set_contact_for_all(world_, 1, 0);
    // two touching balls make no exact pair
    Pose aside;
    aside.p = Vec3(0, 0, 0.25);
    const ShapePtr ball = make_sphere(0.25);
    const ShapePtr shape = GetParam() ? ball : make_union({ball, place_shape(ball, aside)});
    a_ = world_.add_body(body_of(shape, {0, 0, 0}, {0, 1, 0}));
    b_ = world_.add_body(body_of(shape, {-4, 1.5, 0}, {2, 0, 0}));
  }
  // r = (2t - 4, 1.5 - t): 5 t^2 - 19 t + 18.25 = 1/4, the lesser root of 5 t^2 - 19 t + 18
  static constexpr double impact_time = (19 - 1.0) / 10;

  World world_;
  BodyId a_ = 0, b_ = 0;
};

TEST_P(Figure5, check_starts_at_the_lesser_claimed_time_in_the_past_of_one) {
  KernelTest kernel(world_);
  kernel.begin();
  kernel.claim_up_to(a_, 3);
  double before = 0;
  while (!kernel.pair(a_, b_) && kernel.claimed_time(b_) < 3) {
    before = kernel.claimed_time(b_);
    kernel.claim(b_);
  }
  const Pair* pair = kernel.pair(a_, b_);
  ASSERT_TRUE(pair);
  EXPECT_LT(before, impact_time);
  EXPECT_LT(kernel.claimed_time(b_), kernel.claimed_time(a_));
  // everything before that claim is known to be free; the check is not begun later
  EXPECT_EQ(pair->from.time, before);
  if (GetParam()) {
    EXPECT_TRUE(pair->pending);
  }

  world_.advance(4);
  EXPECT_EQ(count_of(world_.statistics(), "collisions"), 1);
  // the queue of a: birth and the impact
  const auto queue = world_.state_queue(a_);
  EXPECT_NEAR(queue.back().key.time, impact_time, 1e-12);
  EXPECT_EQ(queue.back().key.kind, KeyKind::impact);
}

INSTANTIATE_TEST_SUITE_P(Exact, Figure5, testing::Values(true));
INSTANTIATE_TEST_SUITE_P(OnGrid, Figure5, testing::Values(false));

// Three balls on a line: b meets c at 2 s, but a meets b at 1 s.  Processing the later impact first
// and the earlier one then removes the later one's states in b *and* in c, and leaves in c's
// queue what was there before.
TEST(LateDiscovery, later_impact_processed_first_is_undone_in_both_bodies) {
  World world;
  world.set_hash(true);
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
  const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
  const BodyId c = add_ball(world, 0.5, {8, 0, 0}, {0, 0, 0});
  KernelTest kernel(world);
  kernel.begin();
  for (const BodyId id : {b, c}) kernel.claim_up_to(id, 2.5);
  ASSERT_TRUE(kernel.pair(b, c) && kernel.pair(b, c)->pending);
  EXPECT_EQ(kernel.pair(b, c)->impact.time, 2);
  kernel.process_impact(b, c);
  EXPECT_EQ(world.state_queue(b).size(), 2u);
  EXPECT_EQ(world.state_queue(c).size(), 2u);

  kernel.claim_up_to(a, 1.5);
  ASSERT_TRUE(kernel.pair(a, b) && kernel.pair(a, b)->pending);
  EXPECT_EQ(kernel.pair(a, b)->impact.time, 1);
  kernel.process_impact(a, b);
  EXPECT_EQ(world.state_queue(a).back().key.time, 1);
  EXPECT_EQ(world.state_queue(b).back().key.time, 1);
  EXPECT_EQ(world.state_queue(c).size(), 1u) << "the undone impact left a trace";
  // claims fall back to where the states were lost
  EXPECT_LE(kernel.claimed_time(b), 1);
  EXPECT_LE(kernel.claimed_time(c), 2);

  // b leaves with 4 m/s at 1 s from 5 m, stops at 7 m where it meets c at 1.5 s, and a comes at 2 s
  world.advance(3);
  EXPECT_EQ(count_of(world.statistics(), "collisions"), 3);
  EXPECT_EQ(world.state(a).velocity, Vec3::Zero());
  EXPECT_EQ(world.state(b).velocity, Vec3(2, 0, 0));
  EXPECT_EQ(world.state(c).velocity, Vec3(4, 0, 0));
  EXPECT_DOUBLE_EQ(world.state(c).position.x(), 14);
}

// A callback with two targets is undone through one of them: no trace in the other.
TEST(LateDiscovery, callback_undone_through_one_target_leaves_no_trace_in_the_other) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
  const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
  BodyDef far = body_of(make_sphere(0.5), {0, 50, 0}, {0, 1, 0});
  far.slots = make_counter();
  const BodyId other = world.add_body(far);
  int calls = 0;
  std::vector<double> seen;
  add_callback(world, {b, other}, 1.25, std::nullopt,
               [&](double, std::span<StateView* const> targets) -> std::optional<double> {
                 ++calls;
                 seen.push_back(targets[0]->state().velocity.x());
                 targets[1]->set_slots(make_counter(calls));
                 targets[1]->set_velocity({targets[0]->state().velocity.x(), 0, 0});
                 targets[1]->draw_random();
                 return std::nullopt;
               });
  KernelTest kernel(world);
  kernel.begin();
  kernel.claim_up_to(b, 1.25);
  kernel.claim_up_to(other, 1.25);
  kernel.process_callback(0);
  ASSERT_EQ(calls, 1);
  EXPECT_EQ(world.state_queue(other).size(), 2u);

  // the impact of a and b at 1 s was not known yet
  kernel.claim_up_to(a, 1.5);
  ASSERT_TRUE(kernel.pair(a, b) && kernel.pair(a, b)->pending);
  kernel.process_impact(a, b);
  EXPECT_EQ(world.state_queue(other).size(), 1u) << "the undone callback left a trace";

  world.advance(2);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(seen, (std::vector<double>{2, 4}));
  EXPECT_EQ(world.state(other).velocity, Vec3(4, 0, 0));
  EXPECT_DOUBLE_EQ(world.state(other).position.x(), 3);
}

// A callback that only read is run again as well: it might decide otherwise now.
TEST(LateDiscovery, callback_that_changed_nothing_runs_again_after_a_rollback) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
  const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
  std::vector<double> seen;
  add_callback(world, {b}, 1.25, 10, [&](double, std::span<StateView* const> targets) {
    seen.push_back(targets[0]->state().velocity.x());
    return std::nullopt;
  });
  KernelTest kernel(world);
  kernel.begin();
  kernel.claim_up_to(b, 1.25);
  kernel.process_callback(0);
  EXPECT_EQ(seen, (std::vector<double>{2}));
  kernel.claim_up_to(a, 1.5);
  kernel.process_impact(a, b);
  world.advance(2);
  EXPECT_EQ(seen, (std::vector<double>{2, 4}));
  EXPECT_EQ(count_of(world.statistics(), "callback_changes"), 0);
}

// An error that is rolled back was never there.
TEST(LateDiscovery, error_of_an_undone_callback_is_never_raised) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
  const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
  int errors = 0;
  add_callback(world, {b}, 1.25, 10,
               [&](double, std::span<StateView* const> targets) -> std::optional<double> {
                 if (targets[0]->state().velocity.x() != 2) return std::nullopt;
                 ++errors;
                 throw UserError("too slow");
               });
  KernelTest kernel(world);
  kernel.begin();
  kernel.claim_up_to(b, 1.25);
  kernel.process_callback(0);
  EXPECT_EQ(errors, 1);
  kernel.claim_up_to(a, 1.5);
  kernel.process_impact(a, b);
  EXPECT_NO_THROW(world.advance(2));
  EXPECT_EQ(errors, 1);
  EXPECT_EQ(world.time(), 2);
}

// Nothing before GVT is touched: an impact there is a bug of ours, and stops the program.
TEST(LateDiscoveryDeathTest, discontinuity_before_gvt_is_an_internal_error) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {0, 0, 0}, {4, 0, 0});
  const BodyId b = add_ball(world, 0.5, {3, 0, 0}, {2, 0, 0});
  KernelTest kernel(world);
  kernel.begin();
  for (const BodyId id : {a, b}) kernel.claim_up_to(id, 1.5);
  ASSERT_TRUE(kernel.pair(a, b) && kernel.pair(a, b)->pending);
  world.kernel().simulation.present.gvt = 1.125;
  EXPECT_DEATH(kernel.process_impact(a, b), "lies before GVT");
}

}  // namespace
}  // namespace tw::test
