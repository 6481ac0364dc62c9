// The exact quadratics against the grid of checks with root finding: the same impacts.
//
// A ball with a smaller one inside is the same solid for collisions, but it is no single sphere:
// its pairs take the certified path.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/schedule.h"

namespace tw::test {
namespace {

ShapePtr double_ball(double radius) {
  return make_union({make_sphere(radius), make_sphere(0.5 * radius)});
}

std::vector<Collision> collisions_of(const std::vector<BodyDef>& bodies, const Vec3& gravity,
                                     double duration, bool doubled) {
  World world;
  world.set_gravity(gravity);
  set_contact_for_all(world, 1, 0);
  for (BodyDef def : bodies) {
    if (doubled && def.shape->is_sphere()) {
      const double radius = def.shape->parts()[0].radius;
      def.shape = double_ball(radius);
      if (!def.fixed && !def.inertia) {
        def.mass = 1;
        def.inertia = 0.4 * radius * radius * Mat3::Identity();
      }
    } else if (!def.fixed && !def.inertia) {
      def.mass = 1;
    }
    world.add_body(def);
  }
  std::vector<Collision> result;
  world.add_collision_observer([&](const Collision& c) { result.push_back(c); });
  world.advance(duration);
  return result;
}

TEST(ExactAndGrid, times_of_single_impacts_agree) {
  Random random(1);
  int hits = 0;
  double worst = 0;
  for (int i = 0; i < 600; ++i) {
    const double r1 = random.real(0.1, 1), r2 = random.real(0.1, 1);
    const Vec3 v1 = random_vector(random, 3), from = 5 * random_vector(random, 1).normalized();
    // aimed at a point near ball 1 at a time near 1 s
    const Vec3 aim = random.real(0, 1.2) * (r1 + r2) * random_vector(random, 0.6);
    const Vec3 v2 = v1 + (aim - from) / random.real(0.5, 1.5);
    const std::vector<BodyDef> bodies = {body_of(make_sphere(r1), Vec3::Zero(), v1, {1, 2, 3}),
                                         body_of(make_sphere(r2), from, v2, {3, -2, 1})};
    const Vec3 gravity = i % 2 ? Vec3(0, 0, -9.81) : Vec3(0, 0, 0);
    const auto exact = collisions_of(bodies, gravity, 2, false);
    const auto grid = collisions_of(bodies, gravity, 2, true);
    ASSERT_EQ(exact.size(), grid.size()) << "shot " << i;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      ++hits;
      // a graze is ill-conditioned: an error of distance counts 1/approach speed
      worst = std::max(worst, std::abs(exact[k].time - grid[k].time) * exact[k].speed);
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_LT(worst, 1e-13);
}

TEST(ExactAndGrid, times_of_bounces_on_a_plane_agree) {
  Random random(2);
  double worst = 0;
  for (int i = 0; i < 100; ++i) {
    BodyDef plane;
    plane.shape = make_half_space({random.real(-0.1, 0.1), 0.05, 1}, 0);
    plane.fixed = true;
    const std::vector<BodyDef> bodies = {
        plane, body_of(make_sphere(0.3), {0, 0, random.real(1, 3)}, random_vector(random, 2))};
    const auto exact = collisions_of(bodies, {0, 0, -9.81}, 1.5, false);
    const auto grid = collisions_of(bodies, {0, 0, -9.81}, 1.5, true);
    ASSERT_EQ(exact.size(), grid.size()) << "shot " << i;
    for (std::size_t k = 0; k < exact.size(); ++k)
      worst = std::max(worst, std::abs(exact[k].time - grid[k].time));
  }
  EXPECT_LT(worst, 1e-12);
}

// A whole gas: the errors grow at each collision, but the first 60 are the same to 1e-12 s.
TEST(ExactAndGrid, gas_of_100_has_the_same_collisions) {
  const Case c = read_case("gas-100");
  const auto exact = collisions_of(c.bodies, c.gravity, c.duration, false);
  const auto grid = collisions_of(c.bodies, c.gravity, c.duration, true);
  ASSERT_EQ(exact.size(), grid.size());
  for (std::size_t k = 0; k < exact.size(); ++k) {
    EXPECT_EQ(exact[k].body1, grid[k].body1);
    EXPECT_EQ(exact[k].body2, grid[k].body2);
    EXPECT_NEAR(exact[k].time, grid[k].time, k < 60 ? 1e-12 : 1e-9) << "collision " << k;
  }
}

}  // namespace
}  // namespace tw::test
