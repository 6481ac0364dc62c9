// The end test without a world: arcs end where their contacts stop telling the truth.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/end-test.h"

#include <gtest/gtest.h>

#include "groups/regroup/propagation.h"
#include "support/small-scene.h"

namespace tw::test {
namespace {

TEST(EndTest, contacts_that_stand_for_all_that_touches_last_to_the_check) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05});
  small.fuse(floor, cube, 0);
  Group& group = *small.graph.tail(small.process(cube))->group;
  const double due = group.next_check();
  test_end(small.scene, small.surroundings, group, small.counters);
  EXPECT_TRUE(group.found.has_value());
  EXPECT_EQ(group.next_check(), due);
  EXPECT_EQ(small.counters.early_ends, 0u);
}

// A cube that stands on one edge and falls over flat: what comes down is seen before it is deep.
void expect_early_end_on_a_floor(BodyKind kind) {
  SmallScene small;
  // one check a second: long after
  small.options.group_check_rate = 1;
  const BodyId floor = small.add_floor();
  small.scene.bodies[floor]->info.kind = kind;
  const double tilt = 0.3, edge = 0.1, half = edge / 2;
  const Quat q(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  const double height = half * (std::cos(tilt) + std::sin(tilt));
  const BodyId cube = small.add_cube(edge, {0, 0, height}, Vec3::Zero(), Vec3(0, -3, 0), q);
  small.fuse(floor, cube, 0);
  Group& group = *small.graph.tail(small.process(cube))->group;
  const double due = group.next_check();
  test_end(small.scene, small.surroundings, group, small.counters);
  EXPECT_LT(group.next_check(), due);
  EXPECT_EQ(small.counters.early_ends, 1u);

  // no deeper there than contacts are meant to be
  const PoseTwist end = small.tail(cube).trajectory().at(group.next_check());
  double lowest = 1;
  for (const double x : {-half, half})
    for (const double y : {-half, half})
      for (const double z : {-half, half})
        lowest = std::min(lowest, (end.x + end.q * Vec3(x, y, z)).z());
  EXPECT_GT(lowest, -0.01 * edge);
}

TEST(EndTest, an_arc_ends_where_another_cube_comes_down_unseen) {
  expect_early_end_on_a_floor(BodyKind::fixed);
}

// A half-space has no radius; it may move, but does not turn.
TEST(EndTest, is_as_good_on_a_floor_that_moves) {
  expect_early_end_on_a_floor(BodyKind::kinematic);
}

TEST(EndTest, is_done_once) {
  SmallScene small;
  const BodyId floor = small.add_floor(), cube = small.add_cube(0.1, {0, 0, 0.05});
  small.fuse(floor, cube, 0);
  Group& group = *small.graph.tail(small.process(cube))->group;
  test_end(small.scene, small.surroundings, group, small.counters);
  const std::uint64_t steps = group.arc->counts().steps;
  test_end(small.scene, small.surroundings, group, small.counters);
  EXPECT_EQ(group.arc->counts().steps, steps);
}

}  // namespace
}  // namespace tw::test
