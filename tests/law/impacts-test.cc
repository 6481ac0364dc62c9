// Impacts of bodies against closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

// v1' = (m1 v1 + m2 v2 + e m2 (v2 - v1)) / (m1 + m2), and the same for 2.
TEST(Impacts, head_on_balls_follow_newton) {
  for (const double e : {0.0, 0.3, 1.0})
    for (const double ratio : {0.01, 1.0, 50.0}) {
      World world;
      world.set_gravity(Vec3::Zero());
      set_contact_for_all(world, e, 0.5);
      BodyDef one = body_of(make_sphere(0.5), {-2, 0, 0}, {3, 0, 0});
      BodyDef two = body_of(make_sphere(0.5), {2, 0, 0}, {-1, 0, 0});
      one.mass = 2;
      two.mass = 2 * ratio;
      const BodyId a = world.add_body(one), b = world.add_body(two);
      world.advance(1);
      const double m1 = 2, m2 = 2 * ratio, p = m1 * 3 - m2;
      EXPECT_NEAR(world.state(a).velocity.x(), (p + e * m2 * -4) / (m1 + m2), 1e-14 * 4);
      EXPECT_NEAR(world.state(b).velocity.x(), (p + e * m1 * 4) / (m1 + m2), 1e-14 * 4);
      EXPECT_EQ(world.state(a).angular_velocity, Vec3::Zero());
    }
}

TEST(Impacts, equal_elastic_balls_exchange_their_velocities_exactly) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  const BodyId a = add_ball(world, 0.5, {-2, 0, 0}, {3, 0, 0});
  const BodyId b = add_ball(world, 0.5, {2, 0, 0}, {-1, 0, 0});
  world.advance(1);
  EXPECT_EQ(world.state(a).velocity, Vec3(-1, 0, 0));
  EXPECT_EQ(world.state(b).velocity, Vec3(3, 0, 0));
}

// A box that falls flat: four corners at once, one bounce, no spin.
TEST(Impacts, box_dropped_flat_bounces_flat) {
  for (const double friction : {0.0, 0.5})
    for (const bool hull : {false, true}) {
      World world;
      set_contact_for_all(world, 0.5, friction);
      add_wall(world, Vec3::UnitZ(), 0);
      std::vector<Vec3> corners;
      for (int i = 0; i < 8; ++i)
        corners.push_back({(i & 1) - 0.5, 0.7 * ((i >> 1 & 1) - 0.5), 0.4 * ((i >> 2 & 1) - 0.5)});
      const ShapePtr shape = hull ? make_hull(corners) : make_box({1, 0.7, 0.4});
      // turned about the vertical, so that nothing is aligned by luck
      BodyDef def = body_of(shape, {0.3, 0.2, 2.2}, Vec3::Zero());
      def.orientation = rotation_by(Vec3(0, 0, 0.3));
      const BodyId box = world.add_body(def);
      const double fall = std::sqrt(2 * 2 / 9.81);
      world.advance(fall + 0.1);
      EXPECT_EQ(count_of(world.statistics(), "collisions"), 1);
      EXPECT_NEAR(world.state(box).velocity.z(), 0.5 * 9.81 * fall - 0.981, 1e-12);
      EXPECT_LT(world.state(box).angular_velocity.norm(), 1e-12);
      EXPECT_LT(world.state(box).velocity.head<2>().norm(), 1e-12);
    }
}

// A box that lands on an edge at horizontal distance d from its centre, without friction:
// P = (1 + e) v / (1/m + d^2/I), the spin is P d / I.
TEST(Impacts, box_on_an_edge_starts_to_spin_by_the_closed_form) {
  for (const double angle : {0.1, 0.5, pi / 4, 1.2}) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 0.6, 0);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(make_box({1, 2, 1}), {0, 0, 2}, {0, 0, -3});
    def.orientation = rotation_by(Vec3(0, angle, 0));
    def.mass = 5;
    const BodyId box = world.add_body(def);
    // just after the impact: soon the other edge follows
    world.advance((2 - 0.5 * (std::cos(angle) + std::sin(angle))) / 3 + 1e-9);
    // the lowest corner of the cross-section: both halves turned
    const double d = -0.5 * std::cos(angle) + 0.5 * std::sin(angle);
    const double m = 5, inertia = m / 12 * (1 + 1), e = 0.6;
    // of (0.5, -0.5) and (-0.5, -0.5), turned about y, the first is lower
    const double x = 0.5 * std::cos(angle) - 0.5 * std::sin(angle);
    EXPECT_DOUBLE_EQ(x, -d);
    const double P = (1 + e) * 3 / (1 / m + d * d / inertia);
    const BodyState s = world.state(box);
    EXPECT_NEAR(s.velocity.z(), -3 + P / m, 1e-12);
    // (x, 0, .) x (0, 0, P) = (0, -x P, 0)
    EXPECT_NEAR(s.angular_velocity.y(), -x * P / inertia, 1e-11);
    EXPECT_NEAR(s.angular_velocity.x(), 0, 1e-12);
    EXPECT_NEAR(s.angular_velocity.z(), 0, 1e-12);
  }
}

// A spinning ball on a wall.  The contact slips with u; P_n = (1 + e) m v_n.  If 2/7 m |u| is
// within mu P_n it stops slipping, else the impulse along the wall is mu P_n.
TEST(Impacts, spinning_ball_on_a_wall_follows_the_closed_form) {
  Random random(3);
  int stuck = 0, slid = 0;
  for (int i = 0; i < 200; ++i) {
    const double e = random.real(), mu = random.real(), r = 0.3, m = 2;
    const Vec3 v(random.real(-2, 2), random.real(-2, 2), random.real(-3, -1));
    const Vec3 w = random_vector(random, 8);
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, e, mu);
    add_wall(world, Vec3::UnitZ(), 0);
    BodyDef def = body_of(make_sphere(r), {0, 0, 1}, v, w);
    def.mass = m;
    const BodyId ball = world.add_body(def);
    world.advance(1);

    const Vec3 arm(0, 0, -r);
    Vec3 slip = v + w.cross(arm);
    slip.z() = 0;
    const double normal = (1 + e) * m * -v.z(), stop = 2.0 / 7 * m * slip.norm();
    Vec3 P = -std::min(stop, mu * normal) * slip.normalized();
    P.z() = normal;
    (stop < mu * normal ? stuck : slid) += 1;
    const Vec3 v_after = v + P / m, w_after = w + arm.cross(P) / (0.4 * m * r * r);
    EXPECT_LT((world.state(ball).velocity - v_after).norm(), 1e-13 * 10);
    EXPECT_LT((world.state(ball).angular_velocity - w_after).norm(), 1e-13 * 100);
  }
  EXPECT_GT(stuck, 20);
  EXPECT_GT(slid, 20);
}

// Linear and angular momentum of two boxes that hit each other anyhow, with friction.
TEST(Impacts, free_pairs_conserve_linear_and_angular_momentum) {
  Random random(4);
  int hits = 0;
  for (int i = 0; i < 100; ++i) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, random.real(), random.real());
    const Vec3 edges[] = {{1, 0.8, 0.5}, {0.7, 0.7, 1.2}};
    BodyId ids[2];
    for (int k = 0; k < 2; ++k) {
      BodyDef def = body_of(make_box(edges[k]), Vec3(k ? 2 : 0, 0, 0) + random_vector(random, 0.2),
                            Vec3(k ? -1 : 1, 0, 0), random_vector(random, 3));
      def.orientation = random_attitude(random);
      def.mass = 1 + k;
      ids[k] = world.add_body(def);
    }
    const auto angular = [&] {
      Vec3 sum = Vec3::Zero();
      for (int k = 0; k < 2; ++k) {
        const BodyState s = world.state(ids[k]);
        const Vec3 squares = edges[k].cwiseProduct(edges[k]);
        const Vec3 moments = (1 + k) / 12.0 * (squares.sum() * Vec3::Ones() - squares);
        const Vec3 w_B = s.orientation.conjugate() * s.angular_velocity;
        sum += (1 + k) * s.position.cross(s.velocity) + s.orientation * moments.cwiseProduct(w_B);
      }
      return sum;
    };
    const Vec3 p = world.total_momentum(), L = angular();
    const double energy = world.total_energy();
    world.advance(2);
    hits += count_of(world.statistics(), "collisions") > 0;
    // contact forces are integrated: what x cross v keeps is the tolerance of their steps
    const bool stepped = count_of(world.statistics(), "fusions") > 0;
    EXPECT_LT((world.total_momentum() - p).norm(), 1e-13 * 4);
    EXPECT_LT((angular() - L).norm(), stepped ? 1e-4 : 1e-12 * 4);
    EXPECT_LE(world.total_energy(), energy * (1 + (stepped ? 1e-6 : 1e-13)));
  }
  EXPECT_GT(hits, 80);
}

// Five touching balls between two that come at the same instant: what goes in comes out.
TEST(Impacts, simultaneous_impacts_conserve_momentum_and_energy) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  for (int i = 0; i < 5; ++i) add_ball(world, 0.25, {0.5 * i, 0, 0}, Vec3::Zero());
  const BodyId left = add_ball(world, 0.25, {-2, 0, 0}, {1, 0, 0});
  const BodyId right = add_ball(world, 0.25, {4, 0, 0}, {-1, 0, 0});
  const Vec3 p = world.total_momentum();
  const double energy = world.total_energy();
  world.advance(5);
  EXPECT_LT((world.total_momentum() - p).norm(), 1e-12);
  EXPECT_NEAR(world.total_energy(), energy, 1e-13 * energy);
  EXPECT_EQ(world.state(left).velocity, Vec3(-1, 0, 0));
  EXPECT_EQ(world.state(right).velocity, Vec3(1, 0, 0));
}

TEST(Impacts, newtons_cradle_sends_out_as_many_as_come_in) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  std::vector<BodyId> rest;
  for (int i = 0; i < 5; ++i) rest.push_back(add_ball(world, 0.25, {0.5 * i, 0, 0}, Vec3::Zero()));
  const BodyId one = add_ball(world, 0.25, {-2, 0, 0}, {1, 0, 0});
  const BodyId two = add_ball(world, 0.25, {-2.5, 0, 0}, {1, 0, 0});
  world.advance(4);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(world.state(rest[static_cast<std::size_t>(i)]).velocity, Vec3::Zero()) << i;
  EXPECT_EQ(world.state(rest[3]).velocity, Vec3(1, 0, 0));
  EXPECT_EQ(world.state(rest[4]).velocity, Vec3(1, 0, 0));
  EXPECT_EQ(world.state(one).velocity, Vec3::Zero());
  EXPECT_EQ(world.state(two).velocity, Vec3::Zero());
}

// A wall that moves with V: an elastic ball leaves with 2V - v, and the wall's work is what it
// gains.
TEST(Impacts, moving_wall_adds_twice_its_speed_and_accounts_for_the_work) {
  for (const double V : {-0.5, 0.25, 2.0})
    for (const bool half_space : {false, true}) {
      World world;
      world.set_gravity(Vec3::Zero());
      set_contact_for_all(world, 1, 0);
      BodyDef wall;
      wall.shape = half_space ? make_half_space(Vec3::UnitX(), 0) : make_box({1, 10, 10});
      const double face = half_space ? 0 : 0.5;
      wall.motion = make_keyframes(
          {{-10, {-face - 10 * V, 0, 0}, {}}, {10, {-face + 10 * V, 0, 0}, {}}}, false);
      world.add_body(wall);
      BodyDef def = body_of(make_sphere(0.25), {3, 0.1, 0.2}, {-2, 0, 0});
      def.mass = 3;
      const BodyId ball = world.add_body(def);
      world.advance(2.5);
      ASSERT_EQ(count_of(world.statistics(), "collisions"), 1);
      EXPECT_NEAR(world.state(ball).velocity.x(), 2 * V + 2, 1e-13 * 6);
      EXPECT_LT(world.state(ball).angular_velocity.norm(), 1e-13);
      const auto table = world.statistics();
      const double gain = number_of(table, "energy_end") - number_of(table, "energy_start");
      EXPECT_NEAR(number_of(table, "kinematic_work"), gain, 1e-12);
      EXPECT_NEAR(gain, 1.5 * ((2 * V + 2) * (2 * V + 2) - 4), 1e-11);
    }
}

// A paddle that swings among balls and boxes with friction: energy out is energy in plus work, less
// what friction took; without friction the books balance.
TEST(Impacts, turning_paddle_accounts_for_its_work) {
  Scene scene = paddle_scene(3);
  World world;
  scene.fill(world);
  set_contact_for_all(world, 1, 0);
  world.advance(scene.duration);
  const auto table = world.statistics();
  const double start = number_of(table, "energy_start"), end = number_of(table, "energy_end");
  const double work = number_of(table, "kinematic_work");
  EXPECT_GT(count_of(table, "collisions"), 50);
  EXPECT_GT(std::abs(work), 1e-3 * start);
  EXPECT_NEAR(end - start, work, 1e-11 * start);
}

}  // namespace
}  // namespace tw::test
