// Rows and heaps between walls that come together: they may buckle, but are not flung.
//
// A row out of line lets its springs go slowly along their normals and fast across them.  Deep
// contacts resist sliding and turning as they resist parting, so that what is stored becomes heat.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "law/squeezed-bodies.h"
#include "support/heap-scenes.h"
#include "support/stability.h"

namespace tw::test {
namespace {

ShapePtr cube() { return make_box(Vec3::Constant(width)); }
ShapePtr ball() { return make_sphere(0.5 * width); }

// A wall of 0.4 m whose face goes along `inward` from `far` to `near` in [0, 1], stays for a second
// and is back at 3.
void add_press(World& world, const Vec3& inward, double far, double near) {
  BodyDef def;
  const Vec3 thick = inward.cwiseAbs();
  def.shape = make_box(6 * Vec3::Ones() - 5.6 * thick);
  const Vec3 out = -(far + 0.2) * inward, in = -(near + 0.2) * inward;
  def.motion = make_keyframes({{0, out, {}}, {1, in, {}}, {2, in, {}}, {3, out, {}}}, true);
  world.add_body(def);
}

struct Outcome {
  double fastest = 0, share = 0, gain = 0, work = 0, deepest = 0;
  std::int64_t squeezed = 0;
};

Outcome run(World& world, const std::vector<BodyId>& bodies, double until) {
  Outcome outcome;
  const double start = world.total_energy();
  for (double when = 0.005; when <= until; when += 0.005) {
    world.advance(when);
    for (const BodyId id : bodies)
      outcome.fastest = std::max(outcome.fastest, world.state(id).velocity.norm());
    const double work = number_of(world.statistics(), "kinematic_work");
    outcome.work = std::max(outcome.work, work);
    outcome.gain = std::max(outcome.gain, world.total_energy() - start - work);
  }
  StabilityOutcome depths;
  measure_depths(world, depths);
  outcome.deepest = depths.deepest_share;
  outcome.share = number_of(world.statistics(), "squeezed_share");
  outcome.squeezed = count_of(world.statistics(), "squeezed");
  return outcome;
}

// `count` bodies a little out of line, pressed to 60 % of their length and let go.
Outcome press_row(const ShapePtr& shape, int count, double friction) {
  World world;
  set_contact_for_all(world, 0.3, friction);
  add_wall(world, Vec3::UnitZ(), 0);
  add_block(world, {0.2, 4, 4}, {-0.1, 0, 0});
  std::vector<BodyId> bodies;
  for (int i = 0; i < count; ++i)
    bodies.push_back(world.add_body(
        body_of(shape, {0.101 + 0.201 * i, 2e-3 * std::sin(5.0 + 7 * i), 0.1}, Vec3::Zero())));
  add_press(world, -Vec3::UnitX(), 0.05 + 0.201 * count, 0.6 * width * count);
  return run(world, bodies, 3.5);
}

void expect_calm(const Outcome& outcome, double fastest, const std::string& name) {
  EXPECT_LT(outcome.fastest, fastest) << name;
  EXPECT_LT(outcome.gain, 1e-3 * outcome.work) << name << ": energy that no wall gave";
  EXPECT_GT(outcome.squeezed, 0) << name;
  EXPECT_LT(outcome.share, 0.7) << name << ": one has all of the overlap";
  EXPECT_LT(outcome.deepest, 0.01) << name << ": not out half a second after the walls";
}

TEST(SqueezedRows, of_boxes_are_not_flung) {
  for (const int count : {2, 3, 5})
    for (const double friction : {0.0, 0.5})
      expect_calm(press_row(cube(), count, friction), 4,
                  std::to_string(count) + " boxes, friction " + std::to_string(friction));
}

// Balls hold each other by friction until they are deep.
TEST(SqueezedRows, of_balls_do_not_roll_away_while_they_are_deep) {
  expect_calm(press_row(ball(), 2, 0.5), 3, "two balls");
}

// Two arms of a metre fold under walls that come at 1.5 m/s.
TEST(SqueezedRows, a_long_one_folds_no_faster_than_its_arms_explain) {
  for (const double friction : {0.0, 0.5})
    expect_calm(press_row(cube(), 10, friction), 14, "friction " + std::to_string(friction));
}

// Four walls close on a heap to 0.24 m; what they leave falls, from a metre at most.
Outcome compact(const ShapePtr& shape, int count, double friction) {
  World world;
  set_contact_for_all(world, 0.3, friction);
  add_wall(world, Vec3::UnitZ(), 0);
  std::vector<BodyId> bodies;
  for (int i = 0; i < count; ++i)
    bodies.push_back(world.add_body(
        body_of(shape, {0.3 * (i % 2) - 0.15, 0.3 * (i / 2 % 2) - 0.15, 0.14 + 0.27 * (i / 4)},
                Vec3::Zero())));
  for (const Vec3& inward : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    add_press(world, inward, 0.6, 0.12);
  return run(world, bodies, 3);
}

TEST(SqueezedRows, a_heap_between_four_walls_stays_there) {
  for (const double friction : {0.0, 0.5})
    expect_calm(compact(cube(), 8, friction), 4, "boxes, friction " + std::to_string(friction));
  expect_calm(compact(ball(), 20, 0), 4, "balls");
}

}  // namespace
}  // namespace tw::test
