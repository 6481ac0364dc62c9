// Why the arcs of groups end, without a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/planned-end.h"

#include <gtest/gtest.h>

#include "support/small-scene.h"

namespace tw::test {
namespace {

TEST(ArcEnds, the_earlier_one_counts_and_of_two_at_one_time_the_first) {
  const ArcEnd a{1, EndReason::motion}, b{2, EndReason::border}, c{1, EndReason::due};
  EXPECT_EQ(earlier(a, b), a);
  EXPECT_EQ(earlier(b, a), a);
  EXPECT_EQ(earlier(a, c), a);
  EXPECT_EQ(earlier(c, a), c);
  EXPECT_EQ(earlier(ArcEnd{}, b), b);
}

TEST(ArcEnds, counts_name_the_most_frequent_reason) {
  EndCounts counts, more;
  counts.note(EndReason::patience);
  more.note(EndReason::neighbour);
  more.note(EndReason::neighbour);
  counts.add(more);
  EXPECT_STREQ(counts.most_frequent(), "neighbour");
}

// What touches is looked at after the longest time of the lattice in which it moves by a twentieth
// of its size: at 0.3 m/s a cube of 0.1 m goes 0.005 m in less than 1/60 s.
TEST(PlannedEnd, is_by_motion_where_nothing_else_bounds_it) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05}, {0.3, 0, 0});
  small.fuse(floor, cube, 0);
  const ArcEnd end = small.group_of(cube).planned;
  EXPECT_EQ(end.reason, EndReason::motion);
  EXPECT_LT(end.time * 0.3, answer::most_travel * 0.1);
  EXPECT_EQ(end.time * 480, std::exp2(std::round(std::log2(end.time * 480))));
}

TEST(PlannedEnd, of_what_rests_is_never) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05});
  small.fuse(floor, cube, 0);
  int checks = 0;
  for (; !small.group_of(cube).at_rest && checks < 1000; ++checks) small.check(cube, {cube});
  ASSERT_TRUE(small.group_of(cube).at_rest);
  EXPECT_EQ(small.group_of(cube).planned, (ArcEnd{never, EndReason::rest}));
}

// A callback that gives a member a new arc leaves the check where it was due.
TEST(PlannedEnd, is_where_the_check_was_due_already) {
  SmallScene small;
  small.options.group_check_rate = 2;  // so that all motion asks for the same interval
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05}, {0.3, 0, 0});
  small.fuse(floor, cube, 0);
  const double due = small.group_of(cube).planned.time;
  ASSERT_EQ(due, 0.5);
  small.regroup({0.75 * due, 0, KeyKind::callback, 0}, Cause::callback, {cube},
                [](Successor& s) { s.point.v.x() += 0.1; });
  EXPECT_EQ(small.group_of(cube).planned, (ArcEnd{due, EndReason::due}));
  EXPECT_EQ(small.group_of(cube).key.time, 0.75 * due);
}

// Blow on blow: the arc that follows lasts no longer than sixteen times what the one before did.
TEST(PlannedEnd, is_soon_where_blow_follows_on_blow) {
  SmallScene small;
  small.options.group_check_rate = 2;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05});
  small.fuse(floor, cube, 0);
  const auto strike = [&](double when) {
    small.regroup({when, 1, KeyKind::impact, pair_id(floor, cube)}, Cause::impact, {cube},
                  [](Successor& s) { s.point.v.x() += 0.01; });
  };
  // the first one cuts a fusion's arc, which was an impact, too
  strike(1e-3);
  strike(2e-3);
  const ArcEnd end = small.group_of(cube).planned;
  EXPECT_EQ(end.reason, EndReason::patience);
  EXPECT_LE(end.time, 2e-3 + 16 * 1e-3);
  EXPECT_EQ(small.group_of(cube).end(), end);
}

// A cube that stands on one edge and falls over flat.
Group& tested_fall(SmallScene& small, double tilt, double rate) {
  small.options.group_check_rate = 1;
  const BodyId floor = small.add_floor();
  const double half = 0.05, height = half * (std::cos(tilt) + std::sin(tilt));
  const Quat q(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  const BodyId cube = small.add_cube(2 * half, {0, 0, height}, Vec3::Zero(), {0, -rate, 0}, q);
  small.fuse(floor, cube, 0);
  Group& group = *small.graph.tail(small.process(cube))->group;
  EXPECT_FALSE(group.found);
  test_end(small.scene, small.surroundings, group, small.counters);
  return group;
}

TEST(FoundEnd, names_the_lie_that_ended_the_arc) {
  SmallScene far, near;
  // edges that are far off when the arc begins are no contacts, near ones are open ones
  const Group& unseen = tested_fall(far, 0.7, 3);
  ASSERT_TRUE(unseen.ended_early());
  EXPECT_EQ(unseen.found->reason, EndReason::unseen);
  const Group& fast = tested_fall(near, 0.05, 3);
  ASSERT_TRUE(fast.ended_early());
  EXPECT_EQ(fast.found->reason, EndReason::fast);
  EXPECT_EQ(fast.end_of(0), *fast.found);
  // a discontinuity of that very instant knows the plan alone
  EXPECT_EQ(fast.next_check_at(fast.key.time), fast.planned.time);
  EXPECT_EQ(fast.next_check_at(fast.key.time + 1e-9), fast.found->time);
}

}  // namespace
}  // namespace tw::test
