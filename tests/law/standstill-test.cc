// Simulated time goes on: what it takes to go through scenes that once stood still.
//
// Counted, not timed: collision checks and steps are functions of the scene.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/multibody-scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

double checks_of(World& world) {
  return static_cast<double>(count_of(world.statistics(), "checks"));
}

// Two that begin a little in each other, and neither close nor part, are done with at once.
TEST(Standstill, what_begins_in_each_other_and_stays_so_is_not_looked_at_again) {
  for (const double depth : {1e-7, 1e-10, 1e-13}) {
    World world;
    world.set_gravity(Vec3::Zero());
    world.add_body(body_of(make_box({1, 1, 1}), {0, 0, 0}, Vec3::Zero()));
    world.add_body(body_of(make_box({1, 1, 1}), {1 - depth, 0, 0}, Vec3::Zero()));
    world.add_body(body_of(make_cylinder(0.5, 1), {0, 0, 1 - depth}, Vec3::Zero()));
    // and one that parts slowly
    world.add_body(body_of(make_box({1, 1, 1}), {0, 1 - depth, 0}, {0, 1e-9, 0}));
    world.advance(1);
    EXPECT_LT(checks_of(world), 100) << depth;
    EXPECT_EQ(count_of(world.statistics(), "collisions"), 0) << depth;
  }
}

// A drum slides 1e-11 m over a floor of 42 km and comes down by 1e-10 m a second, an end first,
// which is four times what rounding may make of no distance there.
TEST(Standstill, what_slides_at_touch_over_a_wide_floor_is_not_looked_at_at_each_grid_point) {
  World world;
  world.set_gravity(Vec3::Zero());
  constexpr double radius = 10, wide = 42000;
  BodyDef floor;
  floor.shape = make_box({wide, wide, 400});
  floor.position = {0, 0, -200};
  floor.fixed = true;
  world.add_body(floor);
  BodyDef drum =
      body_of(make_cylinder(radius, 20), {0, 0, radius + 1e-11}, {50, 0, -1e-10}, {1e-12, 0, 0});
  drum.orientation = rotation_by(0.5 * pi * Vec3::UnitX());
  const BodyId id = world.add_body(drum);
  world.advance(2);
  EXPECT_LT(checks_of(world), 20000);
  EXPECT_NEAR(world.state(id).position.x(), 100, 1e-6);
}

// But what turns back is met where it was, not deeper.
TEST(Standstill, what_begins_in_another_gets_no_deeper) {
  World world;
  set_contact_for_all(world, 0.5, 0.3);
  add_wall(world, Vec3::UnitZ(), 0);
  constexpr double depth = 5e-7;
  const BodyId box = world.add_body(body_of(make_box({1, 1, 1}), {0, 0, 0.5 - depth}, {0, 0, 1}));
  for (int i = 1; i <= 100; ++i) {
    world.advance(0.01 * i);
    // the springs give way to a soft impact by this much
    EXPECT_GT(world.state(box).position.z(), 0.5 - 1e-3);
  }
  EXPECT_GE(count_of(world.statistics(), "collisions"), 1);
}

// A wave of impacts goes through a lattice of cubes that touch: arcs between blows that follow each
// other within microseconds last no longer than they are worth.
TEST(Standstill, a_blow_on_a_lattice_goes_through) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 0.9, 0.3);
  for (int i = 0; i < 64; ++i)
    world.add_body(
        body_of(make_box({0.1, 0.1, 0.1}), 0.1 * Vec3(i % 4, i / 4 % 4, i / 16), Vec3::Zero()));
  BodyDef ball = body_of(make_sphere(0.08), {-1, -0.9, -0.8}, {30, 28, 26});
  ball.density = 7800;
  world.add_body(ball);
  // the blow comes at 0.0291 s
  world.advance(0.031);
  EXPECT_GT(count_of(world.statistics(), "collisions"), 500);
  EXPECT_LT(count_of(world.statistics(), "implicit_steps"), 20000);
}

// A ball strikes one end of 60 touching cubes on the floor.  What feels it reaches the other end,
// and is found in a few rounds, not in one for every two cubes: 8,700 arcs of bodies were made
// then, now 3,400.
TEST(Standstill, a_blow_on_a_row_is_felt_in_few_rounds) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  add_wall(world, Vec3::UnitZ(), 0);
  for (int i = 0; i < 60; ++i)
    world.add_body(body_of(make_box({0.2, 0.2, 0.2}), {0.2 * i, 0, 0.1}, Vec3::Zero()));
  BodyDef ball = body_of(make_sphere(0.1), {-0.4, 0, 0.1}, {5, 0, 0});
  ball.density = 5000;
  const BodyId striker = world.add_body(ball);
  world.advance(0.5);
  EXPECT_GT(world.state(striker).position.x(), -0.25) << "it has not got there";
  EXPECT_GT(count_of(world.statistics(), "collisions"), 30);
  EXPECT_LT(count_of(world.statistics(), "integrations"), 5000);
}

// Drums in touch along lines, hit by one, or lying in a row: pairs that slide, roll and tilt
// against each other along the line.
TEST(Standstill, drums_in_touch_along_lines_go_on) {
  for (const bool heavy : {false, true}) {
    World world;
    set_contact_for_all(world, 0.4, 2);
    world.set_gravity(heavy ? Vec3(0, 0, -9.81) : Vec3(0, 0, 0));
    add_wall(world, Vec3::UnitZ(), 0);
    const double r = 0.04;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 2; ++k)
        world.add_body(
            body_of(make_cylinder(r, 2 * r), {2 * r * i, 0, r + 2 * r * k}, Vec3::Zero()));
    world.add_body(body_of(make_cylinder(r, 2 * r), {-4 * r, 0.1 * r, r}, {2, 0, 0}));
    world.advance(0.4);
    EXPECT_LT(checks_of(world), 20000) << (heavy ? "with" : "without") << " gravity";
  }
}

// Rods that slide across rods, an edge and a rim: arcs ended as soon as what slides had left the
// point at which the two crossed when they began.
TEST(Standstill, what_crosses_and_slides_has_arcs_as_long_as_its_checks_are_apart) {
  const double r = 4e-4;
  const ShapePtr rod = make_cylinder(r, 0.2), coin = make_cylinder(0.05, 1e-3);
  struct Support {
    ShapePtr shape;
    Quat orientation;
    double height;  // of its top over its middle
  };
  const ShapePtr small_coin = make_cylinder(0.02, 1e-3);
  const double tilt = 0.4, almost_flat = 0.02;
  const Support supports[] = {
      {rod, rotation_by(Vec3(pi / 2, 0, 0)), r},
      {make_box({0.01, 0.2, 0.01}), rotation_by(Vec3(0, pi / 4, 0)), 0.01 * std::sqrt(0.5)},
      {coin, rotation_by(Vec3(0, pi / 2 - tilt, 0)), 0.05 * std::cos(tilt) + 5e-4 * std::sin(tilt)},
      {small_coin, rotation_by(Vec3(0, almost_flat, 0)),
       0.02 * std::sin(almost_flat) + 5e-4 * std::cos(almost_flat)}};
  for (const Support& support : supports) {
    World world;
    set_contact_for_all(world, 0, 0.2);
    for (const double x : {-0.05, 0.05}) {
      BodyDef rail = body_of(support.shape, {x, 0, -support.height}, Vec3::Zero());
      rail.fixed = true;
      rail.orientation = support.orientation;
      world.add_body(rail);
    }
    BodyDef slider = body_of(rod, {0, 0, r}, {0.1, 0.3, 0});
    slider.orientation = rotation_by(Vec3(0, pi / 2, 0));
    const BodyId id = world.add_body(slider);
    world.advance(0.03);
    EXPECT_GT(count_of(world.statistics(), "group_checks"), 50);
    EXPECT_LT(count_of(world.statistics(), "early_ends"), 10) << support.height;
    EXPECT_LT(world.state(id).position.z(), r + 1e-6);
  }
}

// What lies on a floor gives on what it is given: a body that is a thousand times as heavy is
// stopped by thousands of blows on it, which are one impact.
TEST(Standstill, a_heavy_body_is_stopped_by_a_light_one_in_few_impacts) {
  World world;
  set_contact_for_all(world, 0.2, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  world.add_body(body_of(make_box(Vec3::Constant(0.2)), {0, 0, 0.1}, Vec3::Zero()));
  BodyDef heavy = body_of(make_box(Vec3::Constant(0.2)), {0.03, 0.02, 0.35}, {0, 0, -2});
  heavy.density = 1e6;
  const BodyId id = world.add_body(heavy);
  world.advance(0.2);
  EXPECT_LT(count_of(world.statistics(), "collisions"), 100);
  EXPECT_EQ(count_of(world.statistics(), "soft_after_repeats"), 0);
  EXPECT_NEAR(world.state(id).position.z(), 0.3, 0.002);
}

// Without gravity, pushed along a wall that it touches and turned about the wall's normal: what
// turns about the normal comes no nearer.  It was looked at at every grid point.
TEST(Standstill, what_is_turned_along_the_face_that_it_touches_is_looked_at_rarely) {
  for (const ShapePtr& shape : {make_cylinder(0.2, 0.1), make_box({0.3, 0.3, 0.1})}) {
    World world;
    world.set_gravity(Vec3::Zero());
    BodyDef wall = body_of(make_box({10, 10, 1}), {0, 0, -0.5}, Vec3::Zero());
    wall.fixed = true;
    world.add_body(wall);
    const BodyId id = world.add_body(body_of(shape, {0, 0, 0.05}, Vec3::Zero()));
    world.edit(id, [](StateView& view) {
      view.set_applied_force({5, 0, 0});
      view.set_applied_torque({0, 0, 0.1});
    });
    world.advance(1);
    const double mass = shape->mass_properties().volume * 1000;
    EXPECT_NEAR(world.state(id).position.x(), 2.5 / mass, 1e-9);
    EXPECT_LT(count_of(world.statistics(), "certificates"), 100);
  }
}

// A rod of 1:2000 that comes down on its end and a plate (thin:115 of the random scenes): in the
// rod's rows of the linear system a pivot that was large in SI units only lost all digits of its
// momentum, and no step was short enough.
TEST(Standstill, thin_rods_are_stepped_through) {
  World world;
  set_contact_for_all(world, 0.07229665494212612, 0.8328507825875132);
  const double wall = 0.0006092930011907385;
  add_wall(world, Vec3::UnitZ(), 0);
  for (int axis = 0; axis < 2; ++axis)
    for (const double sign : {-1.0, 1.0}) add_wall(world, sign * Vec3::Unit(axis), -wall);
  const double off = 0.000231803503706188, height = 0.0002772551710995582;
  BodyDef rod =
      body_of(make_cylinder(2.2384469529482608e-07, 0.00043179084023701683), {-off, -off, height},
              {0.01423980761950627, -0.012655944545701018, -0.01252042120584999},
              {17.033195883373686, 11.306716895294684, -36.47000044547745});
  rod.orientation =
      Quat(0.9950296741816292, -0.06527294549254796, 0.0318958046197851, 0.068103213818322);
  rod.density = 104.73658256960076;
  world.add_body(rod);
  world.advance(0.01);
  EXPECT_LT(count_of(world.statistics(), "implicit_steps"), 60000);
}

// A wheel that hangs on links without a shape rolls onto a coin.  Those have no size, and an arc
// that ended as it began, since the wheel's rim was deeper than its contact knew, was the next to
// do so: for ever.
TEST(Standstill, links_without_a_shape_end_no_arc_as_it_begins) {
  World world;
  add_wall(world, Vec3::UnitZ(), 0);
  world.add_body(body_of(make_cylinder(0.05, 0.01), {0.5, 0.06, 0.005}, Vec3::Zero()));
  MultibodyDef def;
  def.name = "tool";
  def.position = Vec3(0, 0, 0.15);
  const auto add = [&](const char* name, const char* parent, multibody::JointKind kind,
                       const Vec3& axis) -> LinkDef& {
    LinkDef link;
    link.name = name;
    link.parent = parent;
    link.joint.kind = kind;
    link.joint.axis = axis;
    link.body.inertia = Mat3::Identity();
    link.body.center_of_mass = Vec3::Zero();
    def.links.push_back(link);
    return def.links.back();
  };
  add("x", "", multibody::JointKind::prismatic, Vec3::UnitX()).body.mass = 10;
  add("z", "x", multibody::JointKind::prismatic, Vec3::UnitZ()).body.mass = 5;
  LinkDef& wheel = add("wheel", "z", multibody::JointKind::revolute, Vec3::UnitY());
  wheel.body = {};
  wheel.body.shape =
      place_shape(make_cylinder(0.15, 0.08),
                  Pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()))});
  const std::uint32_t tool = world.add_multibody(def);
  set_velocity(world, tool, 0, 1);
  set_velocity(world, tool, 2, 1 / 0.15);
  // a hundred times what it takes
  EXPECT_EQ(world.advance(1, 20), RunStatus::finished);
  EXPECT_LT(count_of(world.statistics(), "group_checks"), 5000);
}

}  // namespace
}  // namespace tw::test
