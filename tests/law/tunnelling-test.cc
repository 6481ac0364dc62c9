// No tunnelling: small fast bodies and thin plates, thousands of shots against exact prediction.
//
// Pairs are looked at on a grid of h = 2^-20 s, and between its points where they could pass
// through each other meanwhile (detect/dip.h): so at any speed.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>

#include "collision/distance/separation.h"
#include "integrate/given/keyframes.h"

#include "support/scene.h"
#include "support/schedule.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

// One world with a plate 1 mm thin in the plane z = 0 and one shot at it; returns the collisions.
std::vector<Collision> shoot(const ShapePtr& plate, const BodyDef& bullet, double duration) {
  World world;
  world.set_gravity(Vec3::Zero());
  set_contact_for_all(world, 1, 0);
  BodyDef def;
  def.shape = plate;
  def.fixed = true;
  world.add_body(def);
  world.add_body(bullet);
  std::vector<Collision> hits;
  world.add_collision_observer([&](const Collision& c) { hits.push_back(c); });
  world.advance(duration);
  return hits;
}

// From 10 m/s to 100 km/s, which passes through a plate of 1 mm in a hundredth of h.
double random_speed(Random& random) { return std::pow(10.0, random.real(1, 5)); }

// A ball of 0.1 to 10 mm at 10 m/s to 100 km/s aimed at a point of the plate's face: it meets the
// face when its centre is a radius above it.
TEST(Tunnelling, fast_small_spheres_hit_a_thin_plate_at_the_exact_time) {
  Random random(1);
  const double thickness = 1e-3;
  const ShapePtr plate = make_box({1, 1, thickness});
  double worst = 0;
  for (int i = 0; i < 1500; ++i) {
    const double radius = std::pow(10.0, random.real(-4, -2));
    const double speed = random_speed(random);
    const Vec3 aim(random.real(-0.45, 0.45), random.real(-0.45, 0.45), 0.5 * thickness);
    Vec3 from = random_vector(random, 2);
    from.z() = random.real(0.5, 3);
    const Vec3 direction = (aim + Vec3(0, 0, radius) - from).normalized();
    const double flight = (aim + Vec3(0, 0, radius) - from).norm() / speed;
    const auto hits =
        shoot(plate, body_of(make_sphere(radius), from, speed * direction), 1.5 * flight);
    ASSERT_EQ(hits.size(), 1u) << "shot " << i << ", radius " << radius << ", speed " << speed;
    worst = std::max(worst, std::abs(hits[0].time - flight) * speed);
  }
  // 3 m of path with 1e-16 relative, divided by the cosine of the angle of incidence
  EXPECT_LT(worst, 1e-13);
}

// Shots that pass the plate's edge at a clearance from 1e-9 to 0.1 m.
TEST(Tunnelling, spheres_that_pass_by_do_not_hit) {
  Random random(2);
  const ShapePtr plate = make_box({1, 1, 1e-3});
  for (int i = 0; i < 500; ++i) {
    const double radius = std::pow(10.0, random.real(-4, -2));
    const double speed = random_speed(random);
    const double clearance = std::pow(10.0, random.real(-9, -1));
    // straight down beside the plate
    const Vec3 from(0.5 + radius + clearance, random.real(-0.4, 0.4), random.real(0.5, 3));
    EXPECT_TRUE(
        shoot(plate, body_of(make_sphere(radius), from, {0, 0, -speed}), 6 / speed).empty());
    // the same nearer by twice the clearance hits
    const Vec3 nearer = from - Vec3(2 * clearance + 0.2 * radius, 0, 0);
    EXPECT_FALSE(
        shoot(plate, body_of(make_sphere(radius), nearer, {0, 0, -speed}), 6 / speed).empty());
  }
}

// Thin tumbling plates against a thin wall far wider than they are: none gets to the other side.
TEST(Tunnelling, tumbling_thin_boxes_do_not_pass_a_thin_plate) {
  Random random(3);
  const ShapePtr plate = make_box({100, 100, 1e-3});
  for (int i = 0; i < 500; ++i) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    BodyDef wall;
    wall.shape = plate;
    wall.fixed = true;
    world.add_body(wall);
    const double speed = std::pow(10.0, random.real(0, 3));
    BodyDef def =
        body_of(make_box({0.3, 0.2, 1e-3}), {0, 0, 2}, {random.real(-0.3, 0.3) * speed, 0, -speed},
                random_vector(random, 10 * speed));
    def.orientation = random_attitude(random);
    const BodyId bullet = world.add_body(def);
    // long enough to be far beyond, had it passed
    for (int k = 1; k <= 8; ++k) {
      world.advance(0.5 * k / speed);
      ASSERT_GT(world.state(bullet).position.z(), 0.5e-3) << "shot " << i << ", speed " << speed;
    }
    EXPECT_GE(count_of(world.statistics(), "collisions"), 1);
    EXPECT_LT(number_of(world.statistics(), "max_penetration"), 1e-9);
  }
}

// Every kind of shape, of proportions up to 1:30, about `size` across.
ShapePtr random_shape(Random& random, double size) {
  const auto part = [&] { return size * std::pow(10.0, random.real(-1.5, 0)); };
  const auto width = [&] { return size * random.real(0.2, 1); };
  switch (random.below(9)) {
    case 0: return make_sphere(0.5 * width());
    case 1: {
      const double x = width(), y = width();
      return make_box({x, y, part()});
    }
    case 2: {
      const double radius = 0.5 * part();
      return make_cylinder(radius, width());
    }
    case 3: {
      const double radius = 0.5 * width();
      return make_cylinder(radius, part());
    }
    case 4: {
      const double radius = 0.5 * part();
      return make_capsule(radius, width());
    }
    case 5: {
      const double radius = 0.5 * part();
      return make_cone(radius, width());
    }
    case 6: {
      const double x = width(), y = width();
      return make_ellipsoid(0.5 * Vec3(x, y, part()));
    }
    case 7: {
      std::vector<Vec3> points;
      const double thick = part();
      for (int i = 0; i < 12; ++i)
        points.push_back(0.5 * random_vector(random, 1).cwiseProduct(Vec3(size, size, thick)));
      return make_hull(points);
    }
    default: {
      const double side = 0.2 * size;
      return make_union(
          {place_shape(make_box({size, side, side}), {}),
           place_shape(make_cone(side, size), Pose{{0.3 * size, 0, 0}, Quat::Identity()})});
    }
  }
}

// No point of the body moves faster about its centre of mass as it flies, m/s: about each principal
// axis it turns no faster than its energy and its angular momentum allow.
double fastest_turning(const BodyDef& def) {
  const MassProperties& mass = def.shape->mass_properties();
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(mass.inertia);
  const Vec3 moments = principal.eigenvalues();
  Mat3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  const Vec3 rates = axes.transpose() * (def.orientation.conjugate() * def.angular_velocity);
  const Vec3 momenta = moments.cwiseProduct(rates);
  const Aabb box = def.shape->bounds(Frame(axes.transpose(), -(axes.transpose() * mass.centroid)));
  const Vec3 reach = box.hi.cwiseMax(-box.lo);
  double fastest = 0;
  for (int i = 0; i < 3; ++i) {
    const double rate =
        std::min(std::sqrt(rates.dot(momenta) / moments[i]), momenta.norm() / moments[i]);
    fastest += rate * std::hypot(reach[(i + 1) % 3], reach[(i + 2) % 3]);
  }
  return fastest;
}

// Two bodies of any kinds that fly towards each other.
struct Encounter {
  BodyDef defs[2];
  double speed = 0;     // m/s, of their centres of mass against each other
  double duration = 0;  // s: long enough to pass

  explicit Encounter(Random& random) {
    const double size_a = std::pow(10.0, random.real(-2, 0)),
                 size = std::pow(10.0, random.real(-2, 0));
    speed = std::pow(10.0, random.real(0, 3)) * size;
    const double spin = std::pow(10.0, random.real(0, 3));
    defs[0] = body_of(random_shape(random, size_a), Vec3::Zero(), Vec3::Zero(),
                      random_vector(random, 0.1 * spin));
    defs[0].orientation = random_attitude(random);
    const Vec3 way = random_vector(random, 1).normalized();
    const Vec3 past = 0.6 * size_a * random_vector(random, 1);
    defs[1] = body_of(random_shape(random, size), Vec3::Zero(), Vec3::Zero(),
                      random_vector(random, spin));
    defs[1].orientation = random_attitude(random);
    // apart however they turn
    const Vec3 from = std::max(1.5 * (size_a + size), 1.01 * reach()) * way;
    defs[1].position = from;
    defs[1].velocity = speed * (past - from).normalized();
    duration = 2 * from.norm() / speed;
  }
  // Whose origins are farther apart than this don't touch, m.
  double reach() const {
    return defs[0].shape->radius_about_origin() + defs[1].shape->radius_about_origin();
  }
  std::string names() const {
    return defs[0].shape->kind_name() + " and " + defs[1].shape->kind_name();
  }
};

// The two as they fly through each other.
class Ghosts {
 public:
  explicit Ghosts(const Encounter& encounter) : encounter_(encounter) {
    world_.set_threads(1);
    world_.set_gravity(Vec3::Zero());
    ContactSettings ghostly;
    ghostly.collide = false;
    world_.set_contact({}, {}, ghostly);
    for (const BodyDef& def : encounter.defs) world_.add_body(def);
  }
  void advance(double when) { world_.advance(when); }
  // m; where they are more than `enough` apart it may be less.
  double distance(double enough) const {
    const BodyState a = world_.state(0), b = world_.state(1);
    const double apart = (b.position - a.position).norm() - encounter_.reach();
    if (apart > enough) return apart;
    const auto frame = [](const BodyState& s) {
      return Frame(s.orientation.toRotationMatrix(), s.position);
    };
    return separation(*encounter_.defs[0].shape, frame(a), *encounter_.defs[1].shape, frame(b))
        .distance;
  }

 private:
  const Encounter& encounter_;
  World world_;
};

// Two bodies of any kinds meet in flight, or pass, at 1 to 1000 sizes a second and spins of up to
// 1000 rad/s.  As they fly through each other they are looked at again before they can have
// touched; where they are nearer than that nothing moves by more than a twentieth of the thinner
// one from look to look.  Before the impact no look finds an overlap, at the impact they touch, and
// without one they pass.
TEST(Tunnelling, any_two_shapes_that_meet_in_flight_hit_when_they_touch) {
  Random random(5);
  constexpr int pairs = 10000;
  constexpr double touch = 1e-9;  // of the thinner one's width
  int met = 0, passed = 0;
  for (int i = 0; i < pairs; ++i) {
    const Encounter encounter(random);
    const auto& defs = encounter.defs;
    std::optional<double> hit;
    {
      World world;
      world.set_threads(1);  // to start others for each of them would take longer
      world.set_gravity(Vec3::Zero());
      set_contact_for_all(world, 1, 0);
      for (const BodyDef& def : defs) world.add_body(def);
      world.add_collision_observer([&](const Collision& c) { hit = hit.value_or(c.time); });
      world.advance(encounter.duration);
    }
    const double thin = std::min(defs[0].shape->least_width(), defs[1].shape->least_width());
    const double fastest = encounter.speed + fastest_turning(defs[0]) + fastest_turning(defs[1]);
    const double step = 0.05 * thin / fastest, end = hit.value_or(encounter.duration);
    Ghosts ghosts(encounter);
    for (double look = 0;;) {
      const double distance = ghosts.distance(0.05 * thin);
      ASSERT_GT(distance, -touch * thin)
          << "pair " << i << ", " << encounter.names() << ", overlap at " << look
          << (hit ? ", hit at " + std::to_string(*hit) : ", no hit");
      look += std::max(step, 0.9 * distance / fastest);
      if (look >= end) break;
      ghosts.advance(look);
    }
    if (!hit) {
      ++passed;
      continue;
    }
    ++met;
    ghosts.advance(*hit);
    EXPECT_NEAR(ghosts.distance(0), 0, touch * thin) << "pair " << i << ", " << encounter.names();
  }
  EXPECT_EQ(met + passed, pairs);
  EXPECT_GT(met, pairs / 2);
  EXPECT_GT(passed, pairs / 4);
}

// A plate that moves towards the bullet, both fast.
TEST(Tunnelling, bullet_does_not_pass_a_moving_plate) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    World world;
    world.set_gravity(Vec3::Zero());
    set_contact_for_all(world, 1, 0);
    const double plate_speed = random.real(-50, 200), speed = random.real(100, 1000);
    BodyDef plate;
    plate.shape = make_box({1, 1, 1e-3});
    plate.motion =
        make_keyframes({{0, {0, 0, 0}, {}}, {0.01, {0, 0, 0.01 * plate_speed}, {}}}, false);
    world.add_body(plate);
    BodyDef def = body_of(make_sphere(1e-3), {0.1, 0.2, 1}, {0, 0, -speed});
    const BodyId bullet = world.add_body(def);
    const double impact_time = (1 - 1.5e-3) / (speed + plate_speed);
    std::vector<double> times;
    world.add_collision_observer([&](const Collision& c) { times.push_back(c.time); });
    world.advance(0.01);
    if (impact_time > 0.0099) continue;
    ASSERT_EQ(times.size(), 1u) << "shot " << i;
    EXPECT_NEAR(times[0], impact_time, 1e-12);
    EXPECT_NEAR(world.state(bullet).velocity.z(), 2 * plate_speed + speed, 1e-9);
  }
}

// Two capsules that are nearly parallel and close like scissors: a plane between them turns fast,
// and what is about their axes lies the farther along its normal the longer that grows.
TEST(Tunnelling, capsules_that_close_like_scissors_meet_where_they_touch) {
  for (const double tilt : {0.015, -0.005, -0.01, -0.015, -0.03})
    for (const double speed : {1.0, 4.24, 20.0}) {
      World world;
      world.set_gravity(Vec3::Zero());
      set_contact_for_all(world, 0, 0.3);
      const ShapePtr capsule =
          place_shape(make_capsule(0.06, 0.1),
                      Pose{Vec3::Zero(), Quat(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()))});
      BodyDef turning = body_of(capsule, Vec3::Zero(), Vec3::Zero(), {0.5, 0, 0.1});
      turning.orientation = Quat(Eigen::AngleAxisd(tilt, Vec3(1, 0, 0.0016 / tilt).normalized()));
      world.add_body(turning);
      world.add_body(body_of(capsule, {0, 0, 0.14}, {0, 0, -speed}));
      StabilityOutcome outcome;
      for (int i = 1; i <= 200; ++i) {
        world.advance(0.02 / speed * i / 100);
        measure_depths(world, outcome);
      }
      EXPECT_LT(outcome.deepest, 1.2e-4) << tilt << ", " << speed;
    }
}

}  // namespace
}  // namespace tw::test
