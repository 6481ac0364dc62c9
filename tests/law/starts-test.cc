// What came to rest can be a start: bodies may overlap as contacts do, and what was rounded off
// their poses is nothing; deeper overlaps are refused, or pushed apart slowly.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "determinism/compare-schedules.h"
#include "support/scenes.h"

namespace tw::test {
namespace {

BodyId put(World& world, const ShapePtr& shape, const Vec3& position,
           const Quat& orientation = Quat::Identity(), const Vec3& velocity = Vec3::Zero()) {
  BodyDef def = body_of(shape, position, velocity);
  def.orientation = orientation;
  return world.add_body(def);
}

BodyId add_block(World& world, const Vec3& size, const Vec3& position) {
  BodyDef def;
  def.shape = make_box(size);
  def.position = position;
  def.fixed = true;
  return world.add_body(def);
}

// How the dynamic bodies of a world go on from now: looked at every hundredth of a second.
struct Course {
  double way = 0;      // the farthest of any, m
  double speed = 0;    // the fastest of any, m/s
  double kinetic = 0;  // the most of all together, J
  double rise = 0;     // the most of the energy of all, J
};

Course course_of(World& world, double duration) {
  std::vector<BodyState> start;
  for (BodyId id = 0; id < world.body_count(); ++id) start.push_back(world.state(id));
  Course course;
  double lowest = never;
  const int looks = static_cast<int>(std::ceil(100 * duration));
  const double begun = world.time();
  for (int i = 1; i <= looks; ++i) {
    world.advance(begun + duration * i / looks);
    double kinetic = 0;
    for (BodyId id = 0; id < world.body_count(); ++id) {
      if (world.body(id).kind != BodyKind::dynamic) continue;
      const BodyState now = world.state(id);
      course.way = std::max(course.way, (now.position - start[id].position).norm());
      course.speed = std::max(course.speed, now.velocity.norm());
      kinetic += world.kinetic_energy(id);
    }
    course.kinetic = std::max(course.kinetic, kinetic);
    const double energy = world.total_energy();
    lowest = std::min(lowest, energy);
    course.rise = std::max(course.rise, energy - lowest);
  }
  return course;
}

// ---- poses read back ----

using Put = std::function<Pose(int, Pose)>;

ShapePtr piece_of_heap(int i) {
  switch (i % 4) {
    case 0: return make_box({0.3, 0.3, 0.3});
    case 1: return rock_shape(static_cast<std::uint64_t>(i));
    case 2: return make_sphere(0.15);
    default: return make_box({0.5, 0.3, 0.1});
  }
}

// A heap in a pit of 1 m.
void add_heap(World& world, int count, const Put& place, double higher = 0) {
  set_contact_for_all(world, 0.2, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  for (const Vec3& n : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY())}) {
    add_wall(world, n, -0.5);
    add_wall(world, -n, -0.5);
  }
  for (int i = 0; i < count; ++i) {
    const Pose above{{0.21 * (i % 3 - 1), 0.17 * (i / 3 % 3 - 1), 0.3 + 0.6 * i + higher},
                     Quat::Identity()};
    const Pose pose = place(i, above);
    BodyDef def = body_of(piece_of_heap(i), pose.p, Vec3::Zero());
    def.orientation = pose.q;
    world.add_body(def);
  }
}

double kinetic_energy(const World& world, int first, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += world.kinetic_energy(static_cast<BodyId>(first + i));
  return sum;
}

double six_decimals(double x) { return std::round(1e6 * x) * 1e-6; }

TEST(Starts, a_heap_stands_where_its_poses_are_read_back) {
  constexpr int count = 14, walls = 5;
  ContactSettings rolling;
  rolling.rolling_friction = 0.01;
  int at_rest = 0;
  for (int heap = 0; heap < 6; ++heap) {
    World first;
    add_heap(
        first, count, [](int, Pose above) { return above; }, 1e-3 * heap);
    first.set_contact({}, {}, rolling);
    first.advance(12);
    if (heap > 0 && kinetic_energy(first, walls, count) > 0) continue;
    ++at_rest;
    const auto read_back = [&](int i, Pose) {
      const BodyState state = first.state(static_cast<BodyId>(walls + i));
      return Pose{state.position, state.orientation};
    };
    const auto rounded = [&](int i, Pose above) {
      Pose pose = read_back(i, above);
      for (int axis = 0; axis < 3; ++axis) pose.p[axis] = six_decimals(pose.p[axis]);
      pose.q = Quat(six_decimals(pose.q.w()), six_decimals(pose.q.x()), six_decimals(pose.q.y()),
                    six_decimals(pose.q.z()))
                   .normalized();
      return pose;
    };
    for (const Put& place : {Put(read_back), Put(rounded)}) {
      World world;
      add_heap(world, count, place);
      world.set_contact({}, {}, rolling);
      const Course course = course_of(world, 2);
      EXPECT_LT(course.way, 1e-4 * 0.3) << heap;
      // of some 300 J; the worst of these heaps moves with 1.5e-4 J and rises by 1.3e-4
      const double energy = heap == 0 ? 1e-4 : 5e-4;
      EXPECT_LT(course.kinetic, energy) << heap;
      EXPECT_LT(course.rise, energy) << heap;
    }
  }
  EXPECT_GE(at_rest, 3);
}

// ---- right angles ----

TEST(Starts, a_right_angle_with_five_digits_is_one) {
  const Quat about_x = rotation_by({1.5708, 0, 0}), about_y = rotation_by({0, 1.5708, 0});
  const Quat about_z = rotation_by({0, 0, 1.5708});
  const std::vector<std::function<void(World&)>> scenes = {
      [&](World& world) {
        put(world, make_box({0.4, 0.2, 0.6}), {0, 0, 0.1}, about_x);
      },
      [&](World& world) {
        add_block(world, {0.2, 2, 2}, {-0.3, 0, 1});
        put(world, make_box({0.4, 0.4, 0.6}), {0.1, 0, 0.2}, about_y);
      },
      [&](World& world) {
        for (int i = 0; i < 8; ++i)
          put(world, make_box({0.4, 0.2, 0.6}), {0, 0, 0.1 + 0.2 * i},
              i % 2 ? Quat(about_z * about_x) : about_x);
      }};
  for (const auto& fill : scenes) {
    World world;
    add_wall(world, Vec3::UnitZ(), 0);
    fill(world);
    const Course course = course_of(world, 2);
    EXPECT_LT(course.way, 1e-5);
    EXPECT_LT(course.rise, 1e-6);
  }
}

// ---- a micrometre ----

TEST(Starts, what_rests_may_be_nudged_by_a_micrometre) {
  for (const double nudge : {1e-6, -1e-6}) {
    World world;
    set_contact_for_all(world, 0.2, 0.5);
    add_wall(world, Vec3::UnitZ(), 0);
    for (int i = 0; i < 6; ++i)
      put(world, make_box({0.3, 0.3, 0.3}), {0.03 * i, 0.02 * (i % 3), 0.15 + 0.32 * i});
    world.advance(5);
    for (const BodyId id : {1u, 3u, 6u}) {
      world.edit(id, [&](StateView& view) {
        const BodyState state = view.state();
        view.set_pose(state.position + Vec3(0, 0, nudge), state.orientation);
      });
      const Course course = course_of(world, 0.5);
      EXPECT_LT(course.way, 2e-5) << id;
      EXPECT_LT(course.speed, 1e-3) << id;
    }
  }
}

// ---- no energy ----

const std::vector<std::pair<ShapePtr, double>> halves = {
    {make_sphere(0.5), 0.5}, {make_box({1, 1, 1}), 0.5}, {make_capsule(0.5, 1), 0.5}};

TEST(Starts, overlaps_give_no_energy) {
  for (const double depth : {1e-5, 1e-3, 4e-3})
    for (const auto& [shape, half] : halves) {
      // in free flight and in free fall, at rest
      for (const double gravity : {0.0, g}) {
        World world;
        world.set_gravity({0, 0, -gravity});
        put(world, shape, {0, 0, 100});
        put(world, shape, {2 * half - depth, 0, 100});
        world.advance(1);
        for (const BodyId id : {0u, 1u})
          EXPECT_LT((world.state(id).velocity - Vec3(0, 0, -gravity)).norm(), 1e-9) << depth;
      }
      // on what carries it: it sinks no deeper than that, and rises by less
      World world;
      add_wall(world, Vec3::UnitX(), 0);
      world.set_gravity({-g, 0, 0});
      const BodyId body = put(world, shape, {half - depth, 0, 0});
      const Course course = course_of(world, 1);
      EXPECT_LT(course.way, 1e-6) << depth;
      EXPECT_LT(course.speed, 1e-6) << depth;
      EXPECT_NEAR(world.state(body).position.x(), half - depth, 1e-6);
    }
}

TEST(Starts, what_overlaps_and_parts_goes_as_fast_as_it_was_told) {
  for (const auto& [shape, half] : halves)
    for (const double speed : {1e-3, 0.05, 0.7}) {
      World world;
      world.set_gravity(Vec3::Zero());
      add_wall(world, Vec3::UnitX(), 0);
      const BodyId body = put(world, shape, {half - 5e-4, 0, 0}, Quat::Identity(), {speed, 0, 0});
      world.advance(0.5);
      EXPECT_NEAR(world.state(body).velocity.x(), speed, 1e-9);
      EXPECT_NEAR(world.state(body).position.x(), half - 5e-4 + 0.5 * speed, 1e-9);
    }
}

TEST(Starts, what_overlaps_and_closes_is_struck) {
  for (const auto& [shape, half] : halves)
    for (const double speed : {0.02, 0.7}) {
      World world;
      set_contact_for_all(world, 0.5, 0);
      world.set_gravity(Vec3::Zero());
      add_wall(world, Vec3::UnitX(), 0);
      const BodyId body = put(world, shape, {half - 5e-4, 0, 0}, Quat::Identity(), {-speed, 0, 0});
      world.advance(0.5);
      EXPECT_NEAR(world.state(body).velocity.x(), 0.5 * speed, 1e-9);
    }
}

// Thrown up out of the floor it comes down on it as if it had never been in it.
TEST(Starts, an_overlap_is_forgotten_once_it_is_left) {
  World world;
  set_contact_for_all(world, 1, 0);
  add_wall(world, Vec3::UnitZ(), 0);
  const double depth = 4e-3, speed = 2;
  const BodyId body =
      put(world, make_box({1, 1, 1}), {0, 0, 0.5 - depth}, Quat::Identity(), {0, 0, speed});
  double lowest = never;
  for (int i = 50; i < 1000; ++i) {
    world.advance(1e-3 * i);
    lowest = std::min(lowest, world.state(body).position.z() - 0.5);
  }
  EXPECT_GT(lowest, -1e-5);
}

// ---- deeper ----

TEST(Starts, deep_overlaps_are_refused_and_the_remedy_is_named) {
  World world;
  add_wall(world, Vec3::UnitZ(), 0);
  put(world, make_box({1, 1, 1}), {0, 0, 0.45});
  try {
    world.advance(1);
    FAIL() << "no error";
  } catch (const UserError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("overlap by 0.0"), std::string::npos) << message;
    EXPECT_NE(message.find("#:on-overlap 'push"), std::string::npos) << message;
  }
}

// The thinner of the two, however wide it is.
TEST(Starts, how_deep_is_deep_goes_by_the_thinner_one) {
  for (const auto& [depth, allowed] : {std::pair(4e-5, true), std::pair(2e-4, false)}) {
    World world;
    world.set_gravity(Vec3::Zero());
    put(world, make_box({1, 1, 1}), {0, 0, 0.5});
    put(world, make_box({1, 1, 0.01}), {0, 0, -0.005 + depth});
    if (allowed)
      world.advance(0.1);
    else
      EXPECT_THROW(world.advance(0.1), UserError);
  }
}

TEST(Starts, deep_overlaps_are_pushed_apart_slowly) {
  const double size = 0.2, most = 0.15 * std::sqrt(g * size);
  struct Pushed {
    const char* name;
    std::function<void(World&)> fill;
    double lies_at;  // height of the last body when all is over; negative: gravity is off
    int pushes = 1;  // one on top of the other
  };
  const ShapePtr cube = make_box(Vec3::Constant(size)), ball = make_sphere(0.5 * size);
  const std::vector<Pushed> scenes = {
      {"half a ball",
       [&](World& world) {
         put(world, ball, {0, 0, 0});
       },
       0.1},
      {"a box",
       [&](World& world) {
         put(world, cube, {0, 0, 0.08});
       },
       0.1},
      {"a box askew",
       [&](World& world) {
         put(world, cube, {0, 0, 0.09}, rotation_by({0.05, 0.1, 0}));
       },
       0.1},
      {"two boxes",
       [&](World& world) {
         put(world, cube, {0, 0, 0.1});
         put(world, cube, {0.16, 0, 0.1});
       },
       0.1},
      {"a stack",
       [&](World& world) {
         for (int i = 0; i < 4; ++i) put(world, cube, {0, 0, 0.08 + 0.18 * i});
       },
       0.7, 4},
      {"two balls in free flight",
       [&](World& world) {
         put(world, ball, {0, 0, 1});
         put(world, ball, {0.1, 0, 1});
       },
       -1}};
  for (const Pushed& scene : scenes) {
    World world;
    world.set({.push_overlaps = true});
    add_wall(world, Vec3::UnitZ(), 0);
    if (scene.lies_at < 0) world.set_gravity(Vec3::Zero());
    scene.fill(world);
    const Course course = course_of(world, 4);
    EXPECT_LT(course.speed, scene.pushes * most) << scene.name;
    const BodyId last = static_cast<BodyId>(world.body_count() - 1);
    if (scene.lies_at > 0) {
      EXPECT_NEAR(world.state(last).position.z(), scene.lies_at, 5e-4) << scene.name;
    }
    for (BodyId id = 1; id < last; ++id)
      EXPECT_GT((world.state(id).position - world.state(last).position).norm(), size - 1e-3)
          << scene.name;
  }
}

// ---- what never moves ----

TEST(Starts, bodies_that_never_move_do_not_complain_of_each_other) {
  World world;
  add_block(world, {1, 1, 1}, {0, 0, 0});
  add_block(world, {1, 1, 1}, {0.3, 0, 0});
  for (const double x : {0.1, 0.4}) {
    BodyDef def;
    def.shape = make_box({1, 1, 1});
    def.motion = make_keyframes({{0, {x, 0, 0}, {}}, {1, {x, 0, 1}, {}}}, false);
    world.add_body(def);
  }
  world.advance(0.5);
}

// ---- seams ----

TEST(Starts, tiles_carry_as_one_plane) {
  const std::vector<ShapePtr> shapes = {make_box({0.63, 0.37, 0.2}), make_box({1, 1, 0.2}),
                                        make_cylinder(0.2, 0.2),
                                        make_hull({{-0.3, -0.2, -0.1},
                                                   {-0.3, 0.2, -0.1},
                                                   {0.3, -0.2, -0.1},
                                                   {0.3, 0.2, -0.1},
                                                   {0, 0, 0.2}})};
  for (const ShapePtr& shape : shapes)
    for (const double side : {0.1, 0.07}) {
      World world;
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 5; ++j)
          add_block(world, {side, side, 0.1}, {side * (i - 3.5), side * (j - 2), -0.05});
      const BodyId body = put(world, shape, {0.013, 0.021, 0.1});
      world.advance(1);
      EXPECT_NEAR(world.state(body).position.z(), 0.1, 1e-6) << side;
    }
}

// What starts loaded and goes on to the next tile keeps its load, as on one plane: it would sink by
// 4e-5 m.
TEST(Starts, loads_go_on_over_seams) {
  for (const ShapePtr& shape :
       {make_box({0.2, 0.2, 0.2}), make_box({0.5, 0.2, 0.2}), make_sphere(0.1)})
    for (const double friction : {0.0, 0.3}) {
      World world;
      set_contact_for_all(world, 0.2, friction);
      for (int i = 0; i < 40; ++i) add_block(world, {0.2, 4, 1}, {-0.4 + 0.2 * i, 0, -0.5});
      const BodyId body = put(world, shape, {0, 0, 0.1}, Quat::Identity(), {3, 0, 0});
      for (const double when : {0.1, 0.4, 1.0}) {
        world.advance(when);
        EXPECT_NEAR(world.state(body).position.z(), 0.1, 2e-5) << when;
      }
    }
}

// ---- one history ----

TEST(Starts, have_one_history) {
  std::vector<Schedule> schedules;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Schedule schedule = adversary_schedule(seed);
    schedule.adversary->head_start = 0.005;
    schedules.push_back(schedule);
  }
  for (const bool push : {false, true}) {
    const double depth = push ? 0.05 : 1e-3;
    const auto fill = [=](World& world) {
      world.set({.push_overlaps = push});
      set_contact_for_all(world, 0.5, 0.4);
      add_wall(world, Vec3::UnitZ(), 0);
      for (int i = 0; i < 4; ++i)
        put(world, make_box({1, 1, 1}), {0, 0, 0.5 - depth + (1 - depth) * i});
      for (int i = 0; i < 4; ++i) add_ball(world, 0.5, {2 + (1 - depth) * i, 0, 0.5}, Vec3::Zero());
      add_ball(world, 0.4, {-2, 0.1, 1.4}, {8, 0, 1});
    };
    expect_one_history({push ? "pushed" : "overlapping", 0.4, fill}, schedules, 1);
  }
}

}  // namespace
}  // namespace tw::test
