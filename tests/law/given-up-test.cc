// What could hide a failure is counted: impulses given up, impacts declared soft.
//
// With a hundred thousand times the mass on either side of a light body each impulse hands on a
// share of 2e-5 of what comes down: more impulses than anybody waits for.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/stability-scenes.h"

namespace tw::test {
namespace {

struct GivenUp {
  std::int64_t impulses = 0, impacts = 0;
  explicit GivenUp(const World& world)
      : impulses(count_of(world.statistics(), "impulses_given_up")),
        impacts(count_of(world.statistics(), "impacts_declared_soft")) {}
};

// A heavy cube stands on a light one; another falls on it.
GivenUp after_blow_on_a_column(double ratio, const Schedule& schedule = {}) {
  World world;
  apply(world, schedule);
  column_scene(2, ratio, 0).fill(world);
  world.advance(1);
  BodyDef hammer = body_of(make_box(Vec3::Constant(0.2)), {0.01, 0.02, 0.51}, {0, 0, -2});
  hammer.density = 1000 * ratio;
  world.add_body(named(hammer, "hammer"));
  world.advance(1.1);
  return GivenUp(world);
}

// A heavy cube falls on a light one: pair by pair, all at one instant.
GivenUp after_heavy_blow(double ratio, const Schedule& schedule = {}) {
  World world;
  apply(world, schedule);
  heavy_blow_scene(ratio, 0.2).fill(world);
  world.advance(0.2);
  return GivenUp(world);
}

TEST(GivenUp, impulses_through_a_light_body_are_counted) {
  EXPECT_EQ(after_blow_on_a_column(1).impulses, 0);
  EXPECT_GT(after_blow_on_a_column(1e5).impulses, 0);
}

TEST(GivenUp, impacts_that_are_too_many_at_one_instant_are_counted) {
  EXPECT_EQ(after_heavy_blow(100).impacts, 0);
  EXPECT_GT(after_heavy_blow(1e4).impacts, 0);
}

// They are those of the committed history: what is undone and done again counts once.
TEST(GivenUp, does_not_depend_on_the_schedule) {
  Schedule undo;
  undo.undo_redo = true;
  Schedule adversary = adversary_schedule(2);
  adversary.adversary->head_start = 0.05;
  const GivenUp column = after_blow_on_a_column(1e5), blow = after_heavy_blow(1e4);
  for (const Schedule& schedule : {undo, adversary})
    EXPECT_EQ(after_blow_on_a_column(1e5, schedule).impulses, column.impulses);
  EXPECT_EQ(after_heavy_blow(1e4, adversary).impacts, blow.impacts);
}

}  // namespace
}  // namespace tw::test
