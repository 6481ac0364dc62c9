// Rolling and sliding against closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "support/schedule.h"

namespace tw::test {
namespace {

// How far a round body of inertia beta m r^2 runs down a slope from rest.
struct Descent {
  double moved = 0, speed = 0, spin = 0;
};

Descent run_down(const ShapePtr& shape, double radius, double angle, double mu, double duration,
                 const Quat& attitude = Quat::Identity()) {
  World world;
  set_contact_for_all(world, 0, mu);
  const Vec3 normal(std::sin(angle), 0, std::cos(angle)),
      down(std::cos(angle), 0, -std::sin(angle));
  add_wall(world, normal, 0);
  BodyDef def = body_of(shape, radius * normal, Vec3::Zero());
  def.orientation = attitude;
  const BodyId id = world.add_body(def);
  world.advance(duration);
  const BodyState s = world.state(id);
  return {(s.position - def.position).dot(down), s.velocity.dot(down), s.angular_velocity.y()};
}

TEST(Rolling, ball_rolls_down_a_slope) {
  const double angle = 0.3, a = 5.0 / 7 * g * std::sin(angle);
  const Descent run = run_down(make_sphere(0.2), 0.2, angle, 0.5, 2);
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.moved, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(0.2 * run.spin, run.speed, 1e-4 * run.speed);
}

TEST(Rolling, ball_slips_down_a_steep_slope) {
  // rolling would need mu >= 2/7 tan
  const double angle = 0.7, mu = 0.1, a = g * (std::sin(angle) - mu * std::cos(angle));
  const double spin = 5.0 / 2 * mu * g * std::cos(angle) / 0.2;
  const Descent run = run_down(make_sphere(0.2), 0.2, angle, mu, 2);
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.spin, 2 * spin, 1e-4 * 2 * spin);
}

TEST(Rolling, cylinder_rolls_down_a_slope) {
  const double angle = 0.2, a = 2.0 / 3 * g * std::sin(angle);
  const Descent run =
      run_down(make_cylinder(0.2, 0.6), 0.2, angle, 0.5, 2, rotation_by(Vec3(pi / 2, 0, 0)));
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.moved, 2 * a, 1e-4 * 2 * a);
}

TEST(Rolling, sliding_ball_ends_at_five_sevenths) {
  World world;
  set_contact_for_all(world, 0, 0.3);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, {4, 0, 0});
  world.advance(2);  // it rolls after 2/7 v0/(mu g) = 0.39 s
  const BodyState s = world.state(ball);
  EXPECT_NEAR(s.velocity.x(), 4 * 5.0 / 7, 1e-4 * 4 * 5.0 / 7);
  EXPECT_NEAR(0.1 * s.angular_velocity.y(), s.velocity.x(), 1e-4 * s.velocity.x());
}

// A cone on its side rolls around its tip: the axis turns about the vertical at W, and the body
// about the line where it touches at W cot(alpha), alpha half the angle at the tip.  Its axis stays
// level to within alpha, and nothing brakes it.
TEST(Rolling, a_cone_rolls_around_its_tip) {
  const double radius = 0.1, height = 0.3, turn = 2;
  const double slant = std::hypot(radius, height), sine = radius / slant, cosine = height / slant;
  World world;
  set_contact_for_all(world, 0, 0.8);
  add_wall(world, Vec3::UnitZ(), 0);
  // the tip at the origin, the line of touch along x: the axis points from the base to the tip
  const Vec3 axis(-cosine, 0, -sine);
  const Vec3 centroid = -0.75 * height * axis;
  BodyDef def = body_of(make_cone(radius, height), centroid, Vec3::Zero());
  def.orientation = Quat::FromTwoVectors(Vec3::UnitZ(), axis);
  def.angular_velocity = Vec3(-turn * cosine / sine, 0, 0);
  def.velocity = def.angular_velocity.cross(centroid);
  const BodyId cone = world.add_body(def);
  const double duration = 3;
  world.advance(duration);
  const BodyState s = world.state(cone);
  const Vec3 tip = s.position + s.orientation * Vec3(0, 0, 0.75 * height);
  const double angle = turn * duration;
  EXPECT_NEAR(tip.norm(), 0, 3e-3);
  EXPECT_NEAR(s.angular_velocity.norm(), turn * cosine / sine, 5e-3 * turn * cosine / sine);
  EXPECT_NEAR(std::remainder(std::atan2(s.position.y(), s.position.x()) - angle, 2 * pi), 0, 0.02);
}

TEST(Rolling, a_capsule_rolls_as_its_inertia_says) {
  const double r = 0.1, angle = 0.2;
  const ShapePtr shape = make_capsule(r, 0.3);
  const MassProperties mass = shape->mass_properties();
  const double a = g * std::sin(angle) / (1 + mass.inertia(2, 2) / (mass.volume * r * r));
  const Descent run = run_down(shape, r, angle, 0.5, 2, rotation_by(Vec3(pi / 2, 0, 0)));
  EXPECT_NEAR(run.speed, 2 * a, 1e-4 * 2 * a);
  EXPECT_NEAR(run.moved, 2 * a, 1e-4 * 2 * a);
}

// Without friction the weight acts at the centre alone, and what an egg that lies on its side has
// of energy stays as it rocks: its height is a function of its attitude.
TEST(Rolling, an_egg_that_rocks_without_friction_keeps_its_energy) {
  World world;
  set_contact_for_all(world, 0, 0);
  add_wall(world, Vec3::UnitZ(), 0);
  const Vec3 semi(0.3, 0.2, 0.12);
  const Quat tilt = rotation_by(Vec3(0.3, 0.2, 0));
  const Vec3 up = tilt.conjugate() * Vec3::UnitZ();
  BodyDef def = body_of(make_ellipsoid(semi), {0, 0, semi.cwiseProduct(up).norm()}, Vec3::Zero());
  def.orientation = tilt;
  const BodyId egg = world.add_body(def);
  world.advance(0.5);  // until the weight rests on it
  const double before = world.total_energy();
  for (int k = 2; k < 20; ++k) {
    world.advance(0.5 * k);
    const BodyState s = world.state(egg);
    const Vec3 n = s.orientation.conjugate() * Vec3::UnitZ();
    EXPECT_NEAR(s.position.z(), semi.cwiseProduct(n).norm(), 2e-4);
    EXPECT_EQ(s.position.x(), 0);
  }
  EXPECT_NEAR(world.total_energy(), before, 1e-3 * before);
}

// A disc that comes down flat: the derivatives of its circle's lowest point have no bound where it
// is level, and runs ended there.
TEST(Rolling, a_disc_dropped_nearly_flat_comes_to_lie) {
  struct Drop {
    double speed, y, spin;
  };
  for (const Drop& drop : {Drop{0.8575632338557815, 0.1173360335046652, -0.14965372069054705},
                           {0, 0, 0.4781888799870749},
                           {0, 0, 0.01835620616448617}}) {
    World world;
    set_contact_for_all(world, 0, 0);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef disc = body_of(make_cylinder(0.06, 0.02), {-0.4, drop.y, 0.13}, {drop.speed, 0, 0});
    disc.angular_velocity = {0, drop.spin, 0};
    const BodyId id = world.add_body(disc);
    ASSERT_NO_THROW(world.advance(0.3)) << drop.spin;
    EXPECT_NEAR((world.state(id).velocity - Vec3(drop.speed, 0, 0)).norm(), 0, 1e-4);
  }
}

// The top of a drum lies in the plane of the floor.  With the drum's rim followed as a circle on an
// ellipsoid, the normal jumped to the far side of its axis where an egg slid over the rim: it was
// flung back.
TEST(Rolling, an_egg_slides_over_a_rim_as_over_the_floor) {
  for (const double y : {0.0, 0.05, 0.1}) {
    World world;
    set_contact_for_all(world, 0, 0);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef drum = body_of(make_cylinder(0.3, 0.2), {0, 0, -0.1}, Vec3::Zero());
    drum.fixed = true;
    world.add_body(drum);
    const BodyId egg = world.add_body(
        body_of(make_ellipsoid({0.09, 0.0675, 0.0375}), {-0.4, y, 0.06}, {0.3, 0, 0}));
    world.advance(0.8);
    EXPECT_NEAR((world.state(egg).velocity - Vec3(0.3, 0, 0)).norm(), 0, 2e-3) << y;
  }
}

// A flat ellipsoid that rocks on a bar, a ball and an egg: followed by balls it gained 1.35 times
// the energy of its swing in 20 s.
TEST(Rolling, a_lens_that_rocks_on_what_is_round_keeps_its_energy) {
  const double R = 0.3, c = 0.1, w = 0.5;
  for (const ShapePtr& below : {make_cylinder(R, 1), make_sphere(R), make_ellipsoid({R, R, 0.5})}) {
    World world;
    set_contact_for_all(world, 0, 2);
    BodyDef bar = body_of(below, {0, 0, -R}, Vec3::Zero());
    bar.fixed = true;
    bar.orientation = rotation_by(Vec3(pi / 2, 0, 0));
    world.add_body(bar);
    BodyDef lens = body_of(make_ellipsoid({0.4, 0.2, c}), {0, 0, c}, {w * c, 0, 0});
    lens.angular_velocity = {0, w, 0};
    const BodyId id = world.add_body(lens);
    const double start = world.total_energy(), swing = world.kinetic_energy(id);
    world.advance(20);
    EXPECT_NEAR(world.total_energy(), start, 0.01 * swing);
  }
}

// A coin of 24 mm that wobbles without slipping: its rim followed by balls, it lost 22 % in 6 s at
// every accuracy.  What the contact's damping takes is 0.085 %.
TEST(Rolling, a_coin_that_wobbles_without_slipping_keeps_its_energy) {
  World world;
  set_contact_for_all(world, 0.3, 5);
  add_wall(world, Vec3::UnitZ(), 0);
  const double r = 0.012, h = 0.002, tilt = 0.3;
  BodyDef coin = body_of(make_cylinder(r, h), Vec3::Zero(), Vec3::Zero());
  coin.angular_velocity = {0, 0, 10};
  coin.orientation = rotation_by(Vec3(pi / 2 - tilt, 0, 0));
  coin.position.z() = r * std::cos(tilt) + 0.5 * h * std::sin(tilt) + 1e-6;
  world.add_body(coin);
  world.advance(0.01);
  const double before = world.total_energy();
  world.advance(6);
  EXPECT_NEAR(world.total_energy(), 0.99915 * before, 2e-4 * before);
}

void set_resistance(World& world, double rolling, double spinning) {
  ContactSettings settings;
  settings.rolling_friction = rolling;
  settings.spinning_friction = spinning;
  world.set_contact({}, {}, settings);
}

// m a = -F and I a/r = F r - rho m g: a = rho g/r /(1 + I/(m r^2)).
TEST(Rolling, rolling_friction_stops_a_ball_and_a_drum_where_the_closed_form_says) {
  const double r = 0.1, v = 1, rho = 1e-3;
  for (const auto& [shape, beta] :
       {std::pair(make_sphere(r), 0.4), std::pair(make_cylinder(r, 0.3), 0.5)}) {
    World world;
    set_contact_for_all(world, 0, 0.5);
    set_resistance(world, rho, 0);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(shape, {0, 0, r}, {v, 0, 0});
    def.orientation = rotation_by(Vec3(pi / 2, 0, 0));
    def.angular_velocity = {0, v / r, 0};
    const BodyId body = world.add_body(def);
    const double a = rho * g / r / (1 + beta), stop = v / a;
    world.advance(0.5 * stop);
    EXPECT_NEAR(world.state(body).velocity.x(), 0.5 * v, 1e-3 * v);
    world.advance(1.5 * stop);
    EXPECT_NEAR(world.state(body).position.x(), 0.5 * v * stop, 1e-3 * v * stop);
    EXPECT_LT(world.state(body).velocity.norm(), 1e-4 * v);
  }
}

// I w' = -rho m g, for a ball and for a coin on its face, whose points share the weight.
TEST(Rolling, spinning_friction_stops_a_ball_and_a_coin_that_spin) {
  const double r = 0.1, w = 20, rho = 2e-3;
  for (const auto& [shape, height, beta] :
       {std::tuple(make_sphere(r), r, 0.4), std::tuple(make_cylinder(r, 0.02), 0.01, 0.5)}) {
    World world;
    set_contact_for_all(world, 0, 0);
    set_resistance(world, 0, rho);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(shape, {0, 0, height}, Vec3::Zero(), {0, 0, w});
    const BodyId body = world.add_body(def);
    const double stop = w * beta * r * r / (rho * g);
    world.advance(0.25 * stop);
    EXPECT_NEAR(world.state(body).angular_velocity.z(), 0.75 * w, 2e-3 * w);
    world.advance(1.2 * stop);
    EXPECT_LT(world.state(body).angular_velocity.norm(), 1e-3 * w);
  }
}

// A slope, or the ball of radius 1 m under it, whose surface is as steep at the origin.
void add_slope(World& world, const Vec3& normal, bool round) {
  if (!round) {
    add_wall(world, normal, 0);
    return;
  }
  BodyDef def = body_of(make_sphere(1), -normal, Vec3::Zero());
  def.fixed = true;
  world.add_body(def);
}

// m g r sin(a) <= rho m g cos(a): up to a slope of rho/r it holds, even where the ball would roll
// off ever faster.  Steeper, m a = m g sin(a) - F and I a/r = F r - rho m g cos(a).
TEST(Rolling, rolling_friction_holds_a_placed_ball_up_to_its_slope) {
  const double r = 0.1, rho = 2e-3;
  for (const bool round : {false, true})
    for (const double share : {0.5, 0.98, 1.02, 2.0}) {
      const double angle = std::atan(share * rho / r);
      World world;
      set_contact_for_all(world, 0, 0.5);
      set_resistance(world, rho, 0);
      const Vec3 normal(std::sin(angle), 0, std::cos(angle));
      add_slope(world, normal, round);
      const BodyId ball = add_ball(world, r, r * normal, Vec3::Zero());
      world.advance(0.5);
      if (share < 1) {
        for (const double later : {1.0, 100.0, 1000.0}) {
          EXPECT_LT((world.state(ball).position - r * normal).norm(), 1e-9 * r);
          EXPECT_EQ(world.state(ball).velocity.norm(), 0);
          EXPECT_EQ(world.state(ball).angular_velocity.norm(), 0);
          world.advance(later);
        }
      } else if (!round) {
        world.advance(4);
        const double a = g * (std::sin(angle) - rho / r * std::cos(angle)) / 1.4;
        EXPECT_NEAR(world.state(ball).velocity.norm(), 4 * a, 1e-3 * 4 * a + 1e-5);
      } else {
        EXPECT_GT(world.state(ball).velocity.norm(), 0);
      }
    }
}

// What rolls up a slope that holds it stops there, and what rolls down one: it rests within the
// time that rest takes, with no energy ever gained.
TEST(Rolling, what_rolling_friction_stops_on_a_slope_rests_there) {
  const double r = 0.1, rho = 5e-3, angle = std::atan(0.5 * rho / r);
  const Vec3 normal(std::sin(angle), 0, std::cos(angle));
  const Vec3 down(std::cos(angle), 0, -std::sin(angle));
  for (const double v : {-0.5, 0.5}) {
    World world;
    set_contact_for_all(world, 0, 0.5);
    set_resistance(world, rho, rho);
    add_wall(world, normal, 0);
    const BodyId ball =
        add_ball(world, r, r * normal, v * down, v / r * Vec3::UnitY() + 3 * normal);
    const double braking =
        g * (rho / r * std::cos(angle) - (v > 0 ? 1 : -1) * std::sin(angle)) / 1.4;
    const double stop = std::abs(v) / braking, way = 0.5 * v * stop;
    double energy = 1e300;
    for (double time = 0.01; time < stop + 0.5; time += 0.01) {
      world.advance(time);
      EXPECT_LE(world.total_energy(), energy);
      energy = world.total_energy() + 1e-6 * g * r;
    }
    EXPECT_EQ(world.state(ball).velocity.norm(), 0);
    EXPECT_EQ(world.state(ball).angular_velocity.norm(), 0);
    const double made = (world.state(ball).position - r * normal).dot(down);
    EXPECT_NEAR(made, way, 2e-3 * std::abs(way));
    const Vec3 there = world.state(ball).position;
    world.advance(1000);
    EXPECT_EQ((world.state(ball).position - there).norm(), 0);
  }
}

// A torque of T against rho m g at most: I w' = T - rho m g, or not at all.
TEST(Rolling, spinning_friction_holds_a_torque_up_to_its_limit) {
  const double r = 0.1, rho = 2e-3;
  for (const double share : {0.9, 1.5}) {
    World world;
    set_contact_for_all(world, 0, 0.5);
    set_resistance(world, 0, rho);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(make_sphere(r), {0, 0, r}, Vec3::Zero());
    const double mass = 2;
    def.mass = mass;
    const BodyId ball = world.add_body(def);
    const double torque = share * rho * mass * g, inertia = 0.4 * mass * r * r;
    world.edit(ball, [&](StateView& view) { view.set_applied_torque({0, 0, torque}); });
    world.advance(3);
    const BodyState s = world.state(ball);
    if (share < 1) {
      EXPECT_EQ(s.angular_velocity.norm(), 0);
      EXPECT_LT(2 * s.orientation.vec().norm(), 1e-6);
    } else {
      const double rate = (torque - rho * mass * g) / inertia;
      EXPECT_NEAR(s.angular_velocity.z(), 3 * rate, 1e-3 * 3 * rate);
    }
  }
}

// A right prism along y on the corners of a regular polygon.
ShapePtr make_prism(int sides, double radius, double length) {
  std::vector<Vec3> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * (i + 0.5) / sides;
    for (const double y : {-0.5, 0.5})
      corners.push_back({radius * std::sin(angle), y * length, -radius * std::cos(angle)});
  }
  return make_hull(corners);
}

// Of its many corners those hold it that are lowest at either end: with others, which changed from
// check to check, it began to roll, and got faster (5.7 J within 20 s).
TEST(Rolling, a_prism_of_many_sides_gets_no_faster) {
  for (const int sides : {100, 200, 500})
    for (const double speed : {0.0, 0.1}) {
      const double radius = 0.12;
      World world;
      set_contact_for_all(world, 0, 0.5);
      add_wall(world, Vec3::UnitZ(), 0);
      BodyDef def = body_of(make_prism(sides, radius, 2 * radius),
                            {0, 0, radius * std::cos(pi / sides)}, {speed, 0, 0});
      def.angular_velocity = {0, speed / radius, 0};
      const BodyId id = world.add_body(def);
      const double start = world.total_energy(), weight = g * world.body(id).mass;
      double most = start;
      for (int i = 1; i <= 20; ++i) {
        world.advance(0.25 * i);
        most = std::max(most, world.total_energy());
      }
      EXPECT_LE(most, start + 1e-6 * weight * radius) << sides << " sides, " << speed << " m/s";
    }
}

// Corners of a base, more than a contact has points: it stays where it is put.
TEST(Rolling, what_stands_on_many_corners_rests_on_a_slope) {
  for (const int sides : {12, 19, 64}) {
    World world;
    set_contact_for_all(world, 0, 0.6);
    const double angle = 0.35;
    const Vec3 normal(std::sin(angle), 0, std::cos(angle));
    add_wall(world, normal, 0);
    BodyDef def = body_of(make_prism(sides, 0.2, 0.2), 0.1 * normal, Vec3::Zero());
    def.orientation = rotation_by({0, angle, 0}) * rotation_by({0.5 * pi, 0, 0});
    const BodyId id = world.add_body(def);
    world.advance(5);
    EXPECT_LT((world.state(id).position - def.position).norm(), 1e-9) << sides;
  }
}

TEST(Rolling, ball_keeps_rolling) {
  World world;
  set_contact_for_all(world, 0, 0.5);
  add_wall(world, Vec3::UnitZ(), 0);
  const BodyId ball = add_ball(world, 0.1, {0, 0, 0.1}, {3, 0, 0}, {0, 30, 0});
  world.advance(10);
  EXPECT_NEAR(world.state(ball).velocity.x(), 3, 1e-6);
  EXPECT_NEAR(world.state(ball).position.x(), 30, 1e-5);
}

}  // namespace
}  // namespace tw::test
