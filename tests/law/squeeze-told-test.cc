// Who is squeezed is told: counted, delivered once, in time order, whatever the schedule; and what
// is only heavily loaded, or held by what gives way, is not.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "law/squeezed-bodies.h"
#include "support/heap-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

struct Told {
  double time;
  BodyId body, one, two;
  double depth, share;
  bool operator==(const Told&) const = default;
};

std::vector<Told> record(World& world, double until, int pieces = 1) {
  std::vector<Told> all;
  world.add_collision_observer(
      [&](const Collision& c) {
        all.push_back({c.time, c.squeezed, c.body1, c.body2, c.depth, c.depth_share});
      },
      CollisionKind::squeezed);
  advance_in_pieces(world, until, pieces);
  return all;
}

BodyId add_moving_wall(World& world, const std::vector<std::pair<double, double>>& faces) {
  BodyDef def;
  def.shape = make_box({0.2, 4, 4});
  std::vector<Keyframe> frames;
  for (const auto& [time, face] : faces) frames.push_back({time, {face + 0.1, 0, 0}, {}});
  def.motion = make_keyframes(frames, true);
  return world.add_body(def);
}

// A wall comes down on `count` cubes between it and a fixed one, goes back and comes again.
struct Row {
  std::vector<BodyId> cubes;
  BodyId wall, moving;

  Row(World& world, int count, double share) {
    set_contact_for_all(world, 0.3, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    wall = add_block(world, {0.2, 4, 4}, {-0.1, 0, 0});
    for (int i = 0; i < count; ++i)
      cubes.push_back(add_box(world, Vec3::Constant(width), {0.105 + 0.203 * i, 0, 0.1}));
    const double least = share * width * count, most = 0.25 * count;
    moving = add_moving_wall(world, {{0, most}, {1, least}, {1.5, least}, {2, most}, {3, least}});
  }
};

TEST(SqueezeTold, once_each_time_that_it_begins_with_who_and_how_deep) {
  World world;
  const Row row(world, 1, 0.5);
  const std::vector<Told> told = record(world, 3.5);
  ASSERT_EQ(told.size(), 2u);
  for (const Told& one : told) {
    EXPECT_EQ(one.body, row.cubes[0]);
    EXPECT_EQ(one.one, row.wall);
    EXPECT_EQ(one.two, row.moving);
    EXPECT_NEAR(one.share, 0.02, 0.02);
    EXPECT_GE(one.share, 0.02);
    EXPECT_DOUBLE_EQ(one.depth, one.share * width);
  }
  EXPECT_LT(told[0].time, 1);
  EXPECT_GT(told[1].time, 2);
  const auto table = world.statistics();
  EXPECT_EQ(count_of(table, "squeezed"), 2);
  EXPECT_NEAR(number_of(table, "squeezed_depth"), 0.25 * width, 1e-4);
  EXPECT_NEAR(number_of(table, "squeezed_share"), 0.25, 1e-3);
  EXPECT_LT(number_of(table, "max_penetration"), 0.03 * width);
}

// Between two plates of a tenth of its width: overlaps are measured by what is thinner.
TEST(SqueezeTold, by_plates_as_soon_as_these_are_deep_in_it) {
  World world;
  world.set_gravity(Vec3::Zero());
  constexpr double thin = 0.1 * width;
  add_block(world, {thin, 4, 4}, {-0.5 * thin, 0, 0});
  const BodyId cube = add_box(world, Vec3::Constant(width), {0.5 * width, 0, 0});
  BodyDef plate;
  plate.shape = make_box({thin, 4, 4});
  const double at = width + 0.5 * thin;
  plate.motion = make_keyframes({{0, {at, 0, 0}, {}}, {1, {at - 0.1 * thin, 0, 0}, {}}}, false);
  world.add_body(plate);
  const std::vector<Told> told = record(world, 1);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].body, cube);
  EXPECT_GE(told[0].share, 0.02);
  EXPECT_NEAR(told[0].share, 0.02, 0.01);
  EXPECT_DOUBLE_EQ(told[0].depth, told[0].share * thin);
}

// In a row each is held by the next, and so on to the walls.
TEST(SqueezeTold, of_a_row_each_is_told_with_its_neighbours) {
  World world;
  world.set_gravity(Vec3::Zero());
  const Row row(world, 3, 0.85);
  const std::vector<Told> told = record(world, 1);
  ASSERT_EQ(told.size(), 3u);
  for (const Told& one : told) {
    const auto at = std::find(row.cubes.begin(), row.cubes.end(), one.body) - row.cubes.begin();
    std::vector<BodyId> between{at > 0 ? row.cubes[static_cast<std::size_t>(at - 1)] : row.wall,
                                at < 2 ? row.cubes[static_cast<std::size_t>(at + 1)] : row.moving};
    std::sort(between.begin(), between.end());
    EXPECT_EQ(one.one, between[0]);
    EXPECT_EQ(one.two, between[1]);
  }
}

// Springs so soft that the weights alone make overlaps of 10 %: what lies on it gives way.
TEST(SqueezeTold, not_of_a_soft_cube_under_a_heavy_one) {
  World world;
  ContactSettings soft;
  soft.stiffness = 5e3;
  world.set_contact({}, {}, soft);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId low = add_box(world, Vec3::Constant(width), {0, 0, 0.1});
  BodyDef heavy = body_of(make_box(Vec3::Constant(width)), {0, 0, 0.3001}, Vec3::Zero());
  heavy.density = 5000;
  world.add_body(heavy);
  EXPECT_TRUE(record(world, 2).empty());
  EXPECT_LT(world.state(low).position.z(), 0.1 - 0.02 * width) << "nothing is deep here";
  EXPECT_EQ(count_of(world.statistics(), "squeezed"), 0);
  EXPECT_GT(number_of(world.statistics(), "max_penetration"), 0.02 * width);
}

// A wedge of 70 degrees that closes on a ball by 8 % of its width: its normals are 110 degrees
// apart. With enough friction the forces are opposite and it has nowhere to go; else it slips out.
TEST(SqueezeTold, of_a_ball_that_friction_holds_in_a_wedge) {
  for (const double friction : {2.0, 0.1}) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 0, friction);
    const double slope = 35 * pi / 180;
    const Vec3 left(std::cos(slope), 0, std::sin(slope));
    const BodyId wall = add_wall(world, left, -0.5 * width);
    BodyDef jaw;
    jaw.shape = make_box({0.2, 1, 1});
    const Quat leaning = rotation_by({0, slope, 0});
    const Vec3 at = (0.5 * width + 0.1) * Vec3(std::cos(slope), 0, -std::sin(slope));
    jaw.motion =
        make_keyframes({{0, at, leaning}, {1, at - Vec3(0.08 * width, 0, 0), leaning}}, false);
    const BodyId moving = world.add_body(jaw);
    const BodyId ball = add_ball(world, 0.5 * width, Vec3::Zero(), Vec3::Zero());
    const std::vector<Told> told = record(world, 1);
    if (friction < 1) {
      EXPECT_TRUE(told.empty());
      EXPECT_GT(world.state(ball).position.z(), 0.05 * width);
      continue;
    }
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].body, ball);
    EXPECT_EQ(told[0].one, std::min(wall, moving));
    EXPECT_EQ(told[0].two, std::max(wall, moving));
    EXPECT_LT(world.state(ball).position.z(), 0.01 * width);
  }
}

// However many points hold the other side.
TEST(SqueezeTold, of_balls_between_a_plate_and_the_floor_each) {
  for (const int side : {2, 5}) {
    World world;
    set_contact_for_all(world, 0, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j)
        add_ball(world, 0.5 * width, {0.25 * i, 0.25 * j, 0.5 * width}, Vec3::Zero());
    const double half = 0.125 * (side - 1);
    add_box(world, {0.25 * side, 0.25 * side, 0.1}, {half, half, width + 0.05});
    BodyDef ram;
    ram.shape = make_box({0.1, 0.1, 0.2});
    const Vec3 top(half, half, width + 0.1 + 0.1);
    ram.motion = make_keyframes(
        {{0, top + Vec3(0, 0, 0.001), {}}, {1, top - Vec3(0, 0, 0.12 * width), {}}}, false);
    world.add_body(ram);
    std::vector<BodyId> bodies;
    for (const Told& one : record(world, 1)) bodies.push_back(one.body);
    std::sort(bodies.begin(), bodies.end());
    const auto balls = static_cast<std::size_t>(side * side);
    for (BodyId ball = 1; ball <= balls; ++ball)
      EXPECT_TRUE(std::binary_search(bodies.begin(), bodies.end(), ball))
          << ball << " of " << balls;
  }
}

TEST(SqueezeTold, the_same_whatever_the_schedule) {
  const auto told = [](const Schedule& schedule) {
    World world;
    apply(world, schedule);
    world.set_gravity(Vec3::Zero());
    const Row row(world, 2, 0.7);
    std::vector<Told> all = record(world, 3.2, schedule.pieces);
    return std::pair(all, world.history_hash());
  };
  const auto expected = told({});
  EXPECT_GE(expected.first.size(), 2u);
  EXPECT_TRUE(std::is_sorted(expected.first.begin(), expected.first.end(),
                             [](const Told& x, const Told& y) { return x.time < y.time; }));
  std::vector<Schedule> others(3);
  others[0].pieces = 7;
  others[1].undo_redo = true;
  others[2].gvt_interval = 1;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    others.push_back(adversary_schedule(seed));
    others.back().adversary->head_start = 0.05;
  }
  for (const Schedule& schedule : others) EXPECT_EQ(told(schedule), expected) << describe(schedule);
}

}  // namespace
}  // namespace tw::test
