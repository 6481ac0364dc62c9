// Validators of the kernel's structures: each finds what it is there for, and names it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "rollback/kernel-access.h"
#include "support/scene.h"

namespace tw::test {
namespace {

// A box at rest on the ground, two more that fly past each other above it, nothing committed.
class Validators : public testing::Test {
 protected:
  Validators() {
    set_contact_for_all(world_, 0, 0.5);
    add_wall(world_, Vec3::UnitZ(), 0);
    lying_ = add_body("lying", {0, 0, 0.5}, Vec3::Zero());
    flying_ = add_body("flying", {-1, 0, 5}, {1, 0, 0});
    other_ = add_body("other", {1, 1.1, 5}, {-1, 0, 0});
    access().begin();
    access().run_uncommitted(0.2);
    world_.kernel().validate_all();
  }
  BodyId add_body(const char* name, const Vec3& position, const Vec3& velocity) {
    BodyDef def = body_of(make_box({1, 1, 1}), position, velocity);
    def.name = name;
    return world_.add_body(def);
  }
  KernelTest access() { return KernelTest(world_); }
  Kernel& kernel() { return world_.kernel(); }
  Simulation& simulation() { return kernel().simulation; }

  World world_;
  BodyId lying_ = 0, flying_ = 0, other_ = 0;
};

// Boxes hold whole bodies: one that holds the centre and all but a corner is not enough.
TEST_F(Validators, of_claims_find_a_box_that_misses_a_corner) {
  EXPECT_EQ(validate_claims(simulation(), kernel().claims), "");
  const Aabb box = simulation().grid.box(flying_);
  Aabb narrow = box;
  narrow.lo.z() += 0.3;
  simulation().grid.place(flying_, narrow, false);
  EXPECT_NE(validate_claims(simulation(), kernel().claims).find("box does not hold flying"),
            std::string::npos)
      << validate_claims(simulation(), kernel().claims);
  simulation().grid.place(flying_, box, false);
  EXPECT_EQ(validate_claims(simulation(), kernel().claims), "");
}

TEST_F(Validators, of_residences_find_a_member_in_the_wrong_place) {
  EXPECT_EQ(validate_residences(simulation()), "");
  State& state = access().tail_of(lying_);
  ASSERT_TRUE(state.group);
  ++state.member;
  EXPECT_NE(validate_residences(simulation()).find("not a member of its group: lying"),
            std::string::npos);
  --state.member;
  EXPECT_EQ(validate_residences(simulation()), "");
}

TEST_F(Validators, of_the_graph_find_a_state_that_was_committed_too_early) {
  EXPECT_EQ(validate_state_graph(simulation()), "");
  State& tail = access().tail_of(lying_);
  ASSERT_GT(tail.key.time, simulation().present.gvt);
  for (State* state = &tail; state && !state->committed; state = state->prev)
    state->committed = true;
  EXPECT_NE(validate_state_graph(simulation()).find("committed after GVT"), std::string::npos);
}

TEST_F(Validators, of_pairs_find_a_record_that_its_bodies_do_not_list) {
  EXPECT_EQ(validate_pairs(simulation(), kernel().pairs), "");
  ActivePairs& pairs = kernel().pairs;
  std::uint32_t index = 0;
  while (index < pairs.size() && !pairs[index].live) ++index;
  ASSERT_LT(index, pairs.size());
  Pair& pair = pairs[index];
  std::swap(pair.a, pair.b);
  EXPECT_NE(validate_pairs(simulation(), pairs).find("ids out of order"), std::string::npos);
  std::swap(pair.a, pair.b);
  ++pair.place_b;
  EXPECT_NE(validate_pairs(simulation(), pairs).find("pair not in its bodies' lists"),
            std::string::npos);
  --pair.place_b;
  EXPECT_EQ(validate_pairs(simulation(), pairs), "");
}

TEST_F(Validators, of_the_queue_find_an_event_of_nobody) {
  EXPECT_EQ(access().validate_event_queue(), "");
  Process& process = simulation().process(simulation().body(flying_));
  const EventQueue::Handle handle = process.advance;
  ASSERT_NE(handle, EventQueue::none);
  process.advance = EventQueue::none;
  EXPECT_NE(access().validate_event_queue().find("advance event of nobody"), std::string::npos);
  process.advance = handle;
}

}  // namespace
}  // namespace tw::test
