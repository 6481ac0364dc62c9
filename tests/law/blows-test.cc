// Blows on what lies, leans, is held or stands at a stop: the restitution of the pair is kept,
// whatever the masses are, and no energy comes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/scene.h"
#include "support/scenes.h"

namespace tw::test {
namespace {

constexpr double drop = 0.5;
const double fall_time = std::sqrt(2 * drop / g), struck_at = g * fall_time;

// A ball of 5 cm and 0.5 kg above `top`, which it reaches at fall_time.
BodyId drop_ball(World& world, double x, double y, double top) {
  BodyDef ball = body_of(make_sphere(0.05), {x, y, top + 0.05 + drop}, Vec3::Zero());
  ball.mass = 0.5;
  return world.add_body(ball);
}

BodyId add_cube(World& world, double x, double z, double mass) {
  BodyDef cube = body_of(make_box({0.1, 0.1, 0.1}), {x, 0, z}, Vec3::Zero());
  cube.mass = mass;
  return world.add_body(cube);
}

// How much of its speed the ball has left, a hundredth of a second after the blow.
double share_left(World& world, BodyId ball) {
  world.advance(fall_time + 0.01);
  return (world.state(ball).velocity.z() + 0.01 * g) / struck_at;
}

TEST(Blows, keep_their_restitution_on_what_lies_whatever_the_masses_are) {
  for (const double e : {0.3, 0.9, 1.0})
    for (const double ratio : {0.01, 0.1, 1.0, 30.0, 1000.0}) {
      World world;
      set_contact_for_all(world, e, 0.3);
      add_floor(world);
      add_cube(world, 0, 0.05, 0.5 * ratio);
      const BodyId ball = drop_ball(world, 0, 0, 0.1);
      EXPECT_NEAR(share_left(world, ball), e, 1e-6) << e << " " << ratio;
    }
}

TEST(Blows, keep_it_on_stacks_and_by_stronges_law) {
  for (const ImpactLaw law : {ImpactLaw::chatterjee_ruina, ImpactLaw::stronge})
    for (const int height : {1, 2, 5}) {
      World world;
      ContactSettings settings;
      settings.restitution = 0.8;
      settings.impact_law = law;
      world.set_contact({}, {}, settings);
      add_floor(world);
      for (int k = 0; k < height; ++k) add_cube(world, 0, 0.05 + 0.1 * k, 0.2 + 0.1 * k);
      const BodyId ball = drop_ball(world, 0, 0, 0.1 * height);
      EXPECT_NEAR(share_left(world, ball), 0.8, 1e-6) << height;
    }
}

// The ground's own restitution has no say in it, nor has that of what lies between.
TEST(Blows, keep_that_of_the_struck_pair_where_others_differ) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  const BodyId floor = add_floor(world), cube = add_cube(world, 0, 0.05, 0.1),
               upper = add_cube(world, 0, 0.15, 0.3);
  const BodyId ball = drop_ball(world, 0, 0, 0.2);
  const auto side = [](BodyId id) { return ContactSide{ContactSide::Kind::body, {}, id}; };
  ContactSettings settings;
  settings.restitution = 0.7;
  world.set_contact(side(ball), side(upper), settings);
  settings.restitution = 0.2;
  world.set_contact(side(cube), side(upper), settings);
  settings.restitution = 1;
  world.set_contact(side(cube), side(floor), settings);
  EXPECT_NEAR(share_left(world, ball), 0.7, 1e-6);
}

// Off the middle of a light plate that lies flat.
TEST(Blows, off_the_middle_gain_no_energy) {
  for (const double x : {0.0, 0.1, 0.2, 0.24}) {
    World world;
    set_contact_for_all(world, 1, 0);
    add_floor(world);
    BodyDef plate = body_of(make_box({0.5, 0.3, 0.02}), {0, 0, 0.01}, Vec3::Zero());
    plate.mass = 0.2;
    world.add_body(plate);
    const BodyId ball = drop_ball(world, x, 0.05, 0.02);
    const double before = world.total_energy();
    EXPECT_NEAR(share_left(world, ball), 1, 1e-6) << x;
    EXPECT_NEAR(world.total_energy(), before, 1e-6 * before) << x;
  }
}

// A plank that leans on a wall, rough: the struck point bounces at e along its normal.
TEST(Blows, keep_it_on_what_leans) {
  World world;
  set_contact_for_all(world, 0.6, 1.5);
  add_floor(world);
  add_wall(world, Vec3::UnitX(), 0);
  const double angle = 0.9, length = 1;
  BodyDef plank = body_of(make_box({length, 0.4, 0.02}), Vec3::Zero(), Vec3::Zero());
  plank.orientation = rotation_by(Vec3(0, angle, 0));
  // the lower corner on the floor, the upper one at the wall
  const double c = std::cos(angle), s = std::sin(angle);
  plank.position = Vec3(0.5 * length * c + 0.01 * s, 0, 0.5 * length * s + 0.01 * c);
  plank.mass = 0.4;
  const BodyId leaning = world.add_body(plank);
  world.advance(0.5);
  const Vec3 normal(s, 0, c);
  const BodyState at = world.state(leaning);
  const Vec3 where = at.position + at.orientation * Vec3(0.1, 0, 0.01);
  BodyDef ball = body_of(make_sphere(0.05), where + 0.06 * normal, -3 * normal);
  ball.mass = 0.5;
  const BodyId id = world.add_body(ball);
  // 1 cm at 3 m/s
  world.advance(0.5 + 0.01 / 3 + 1e-3);
  const BodyState after = world.state(id);
  const double fell = g * (0.01 / 3), turned = g * 1e-3;
  EXPECT_NEAR(after.velocity.dot(normal) + turned * c, 0.6 * (3 + fell * c), 0.01);
}

// What is held answers as one body: two cubes that fall tilted keep what a union of them keeps.
TEST(Blows, move_what_is_held_as_a_union) {
  for (const double e : {1.0, 0.5})
    for (const double tilt : {0.01, 0.3}) {
      World world;
      set_contact_for_all(world, e, 0);
      add_floor(world);
      const Quat q = rotation_by(Vec3(0, tilt, 0));
      const ShapePtr cube = make_box({0.2, 0.2, 0.2});
      const auto put = [&](const ShapePtr& shape, double x, double s) {
        BodyDef def = body_of(shape, Vec3(x, 0, 1) + q * Vec3(s, 0, 0), Vec3::Zero());
        def.orientation = q;
        return world.add_body(def);
      };
      Pose left, right;
      left.p = Vec3(-0.3, 0, 0), right.p = Vec3(0.3, 0, 0);
      const BodyId one = put(make_union({place_shape(cube, left), place_shape(cube, right)}), 0, 0);
      const BodyId a = put(cube, 3, -0.3), b = put(cube, 3, 0.3);
      world.attach(a, b);
      for (const double when : {0.45, 0.6, 0.8}) {
        world.advance(when);
        const Vec3 middle = 0.5 * (world.state(a).position + world.state(b).position);
        EXPECT_NEAR(middle.z(), world.state(one).position.z(), 2e-4) << e << " " << tilt;
      }
    }
}

// A shelf that is held by a wall does not give way.
TEST(Blows, find_what_is_held_by_the_ground_as_hard_as_it) {
  World world;
  set_contact_for_all(world, 0.9, 0.3);
  BodyDef wall = body_of(make_box({0.1, 1, 1}), {-0.05, 0, 1}, Vec3::Zero());
  wall.fixed = true;
  const BodyId ground = world.add_body(wall);
  BodyDef shelf = body_of(make_box({0.3, 0.3, 0.02}), {0.2, 0, 1}, Vec3::Zero());
  shelf.mass = 0.3;
  const BodyId held = world.add_body(shelf);
  world.attach(ground, held);
  const BodyId ball = drop_ball(world, 0.25, 0, 1.01);
  EXPECT_NEAR(share_left(world, ball), 0.9, 1e-4);
}

// A hold that was given a stiffness gives way to a blow: of three equal balls in a row that which
// is struck takes all of it, and its fellow, held by a soft spring, stands still.
TEST(Blows, stretch_a_hold_that_was_made_to_give_way) {
  for (const bool soft : {true, false}) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    const ShapePtr shape = make_sphere(0.1);
    const auto put = [&](double x, double speed) {
      BodyDef def = body_of(shape, {x, 0, 0}, {speed, 0, 0});
      def.mass = 1;
      return world.add_body(def);
    };
    const BodyId shot = put(-0.3, 1), struck = put(0, 0), fellow = put(0.3, 0);
    HoldDef hold;
    if (soft) hold.stiffness = 1;
    world.attach(struck, fellow, hold);
    world.advance(0.1 + 1e-6);
    EXPECT_NEAR(world.state(shot).velocity.x(), soft ? 0 : -1.0 / 3, 1e-5);
    EXPECT_NEAR(world.state(struck).velocity.x(), soft ? 1 : 2.0 / 3, 1e-5);
    EXPECT_NEAR(world.state(fellow).velocity.x(), soft ? 0 : 2.0 / 3, 1e-5);
  }
}

// A board on a hinge along y, from x = 0, at its stop at 0 where its weight presses it.
MultibodyDef flap(double mass, double restitution) {
  MultibodyDef def;
  def.name = "flap";
  def.position = Vec3(0, 0, 1);
  LinkDef link;
  link.name = "board";
  link.joint.axis = Vec3::UnitY();
  link.joint.axes[0].upper = 0;
  link.joint.axes[0].lower = -2;
  link.joint.axes[0].restitution = restitution;
  link.body.shape =
      place_shape(make_box({0.4, 0.3, 0.02}), Pose{Vec3(0.2, 0, 0), Quat::Identity()});
  link.body.mass = mass;
  def.links.push_back(link);
  return def;
}

// At restitution 1 of the stop the flap rocks on it for ever, and moves a little when it is struck.
TEST(Blows, keep_it_on_a_flap_at_its_stop) {
  for (const double stop : {0.0, 0.5, 1.0})
    for (const double mass : {0.05, 0.5, 20.0}) {
      World world;
      set_contact_for_all(world, 0.9, 0.3);
      world.add_multibody(flap(mass, stop));
      world.advance(1);
      BodyDef ball = body_of(make_sphere(0.05), {0.3, 0, 1.06 + drop}, Vec3::Zero());
      ball.mass = 0.5;
      const BodyId id = world.add_body(ball);
      world.advance(1 + fall_time + 0.01);
      EXPECT_NEAR((world.state(id).velocity.z() + 0.01 * g) / struck_at, 0.9,
                  stop < 1 ? 5e-3 : 0.01)
          << stop << " " << mass;
    }
}

// Balls in a row that touch without a load, in contact or not: the last one leaves.
TEST(Blows, pass_through_a_row_that_merely_touches) {
  World world;
  set_contact_for_all(world, 1, 0);
  add_floor(world);
  std::vector<BodyId> row;
  for (int k = 0; k < 5; ++k) row.push_back(add_ball(world, 0.1, {0.2 * k, 0, 0.1}, Vec3::Zero()));
  world.advance(0.5);
  const BodyId first = add_ball(world, 0.1, {-1, 0, 0.1}, {2, 0, 0});
  world.advance(1);
  EXPECT_NEAR(world.state(row[4]).velocity.x(), 2, 1e-6);
  EXPECT_NEAR(world.state(first).velocity.x(), 0, 1e-6);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(world.state(row[static_cast<std::size_t>(k)]).velocity.x(), 0, 1e-6);
}

MultibodyDef pendulum(double x) {
  MultibodyDef def;
  def.position = Vec3(x, 0, 1);
  LinkDef link;
  link.name = "ball";
  link.joint.axis = Vec3::UnitY();
  link.body.shape = place_shape(make_sphere(0.1), Pose{Vec3(0, 0, -0.8), Quat::Identity()});
  link.body.mass = 1;
  def.links.push_back(link);
  return def;
}

// Balls on hinges that touch as they hang, the first of them lifted.
std::vector<BodyId> add_cradle(World& world, int balls, double lift) {
  set_contact_for_all(world, 1, 0);
  std::vector<BodyId> row;
  for (int k = 0; k < balls; ++k)
    row.push_back(world.multibody(world.add_multibody(pendulum(0.2 * k))).links[0]);
  world.edit(row[0], [&](StateView& view) {
    view.change_joints([&](MultibodyState& joints) { joints.q[0] = lift; });
  });
  return row;
}

// How much of its swing's energy is gained by then.
double swing_gained(int balls, double lift, double when) {
  World world;
  add_cradle(world, balls, lift);
  const double before = world.total_energy();
  world.advance(when);
  return (world.total_energy() - before) / (0.8 * g * (1 - std::cos(lift)));
}

// They keep what one pendulum keeps that strikes nothing: the blows lose nothing, whether the balls
// were taken for one group meanwhile or not.
TEST(Blows, keep_the_energy_of_cradles) {
  for (const double lift : {0.2, 0.6}) {
    const double when = long_tests() ? 600.1 : 30.1, alone = swing_gained(1, lift, when);
    for (const int balls : {3, 5})
      EXPECT_NEAR(swing_gained(balls, lift, when), alone, 0.05 * alone) << balls << " " << lift;
  }
}

}  // namespace
}  // namespace tw::test
