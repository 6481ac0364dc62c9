// Clusters that are stepped, against what is known exactly.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/stepped-cluster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "base/random.h"

namespace tw {
namespace {

constexpr double g = 9.81;

// A few bodies over a half-space that may be tilted about y.
class Scene {
 public:
  std::vector<StepMember> members;
  std::vector<StepOutside> outside;
  StepLaw law{0.5, 0};
  StepSettings settings;
  Vec3 gravity{0, 0, -g};

  void add_ground() { outside.push_back({make_half_space(Vec3::UnitZ(), 0), Pose(), nullptr}); }
  // As if the ground were tilted by so many degrees, downhill to +x.
  void tilt(double degrees) {
    const double angle = degrees * pi / 180;
    gravity = g * Vec3(std::sin(angle), 0, -std::cos(angle));
  }
  StepMember& add_box(const Vec3& edges, double density, const Vec3& x) {
    return add(make_box(edges), density, x, edges.minCoeff());
  }
  StepMember& add(const ShapePtr& shape, double density, const Vec3& x, double size) {
    StepMember member;
    member.shape = shape;
    const MassProperties& of = shape->mass_properties();
    member.mass = density * of.volume;
    member.inertia = density * of.inertia;
    member.center = of.centroid;
    member.radius = shape->radius_about_origin();
    member.size = size;
    member.x = x;
    members.push_back(member);
    return members.back();
  }
  std::unique_ptr<SteppedCluster> start() {
    for (StepMember& member : members) member.force = member.mass * gravity;
    const StepLaw all = law;
    return std::make_unique<SteppedCluster>(
        members, outside, [all](int, int) { return all; }, gravity, settings, 0);
  }
};

void advance(SteppedCluster& cluster, double until) {
  while (cluster.time() < until - 1e-9) cluster.advance();
}

double energy(const Scene& scene, const SteppedCluster& cluster) {
  double sum = 0;
  for (std::size_t i = 0; i < scene.members.size(); ++i) {
    const StepMember& member = scene.members[i];
    const PoseTwist at = cluster.state(static_cast<int>(i));
    const Vec3 w = at.q.conjugate() * at.w;
    sum += 0.5 * member.mass * at.v.squaredNorm() + 0.5 * w.dot(member.inertia * w) -
           member.mass * scene.gravity.dot(at.x);
  }
  return sum;
}

TEST(SteppedCluster, what_touches_nothing_flies_its_parabola) {
  Scene scene;
  StepMember& brick = scene.add_box(Vec3(0.1, 0.2, 0.4), 1000, Vec3(0, 0, 10));
  brick.v = Vec3(1, 2, 3);
  brick.w = Vec3(3, 1, 2);
  const auto cluster = scene.start();
  const Vec3 L = brick.inertia * brick.w;
  advance(*cluster, 1);
  const PoseTwist at = cluster->state(0);
  EXPECT_LT((at.x - Vec3(1, 2, 13 - g / 2)).norm(), 1e-12);
  EXPECT_LT((at.v - Vec3(1, 2, 3 - g)).norm(), 1e-12);
  const Mat3 R = at.q.toRotationMatrix();
  EXPECT_LT((R * (brick.inertia * (R.transpose() * at.w)) - L).norm(), 1e-12 * L.norm());
}

TEST(SteppedCluster, a_stack_of_ten_stands_still) {
  Scene scene;
  scene.add_ground();
  scene.settings.step = 1.0 / 480;
  for (int i = 0; i < 10; ++i) scene.add_box(Vec3::Constant(0.2), 1000, Vec3(0, 0, 0.1 + 0.2 * i));
  const auto cluster = scene.start();
  advance(*cluster, 5);
  std::vector<Vec3> before;
  for (int i = 0; i < 10; ++i) before.push_back(cluster->state(i).x);
  advance(*cluster, 10);
  for (int i = 0; i < 10; ++i) {
    const PoseTwist at = cluster->state(i);
    EXPECT_LT((at.x - Vec3(0, 0, 0.1 + 0.2 * i)).norm(), 5e-4) << i;
    EXPECT_LT((at.x - before[static_cast<std::size_t>(i)]).norm(), 1e-9) << i;
    EXPECT_LT(at.v.norm(), 1e-10) << i;
  }
  EXPECT_LT(cluster->deepest(), 2e-4);
}

TEST(SteppedCluster, a_block_sticks_below_the_angle_of_friction_and_slides_above) {
  // mu 0.5: 26.565 degrees
  for (const double degrees : {26.5, 26.63}) {
    Scene scene;
    scene.add_ground();
    scene.tilt(degrees);
    scene.add_box(Vec3(0.4, 0.4, 0.2), 1000, Vec3(0, 0, 0.1));
    const auto cluster = scene.start();
    advance(*cluster, 5);
    const double before = cluster->state(0).x.x();
    advance(*cluster, 10);
    const double angle = degrees * pi / 180;
    const double pull = g * (std::sin(angle) - 0.5 * std::cos(angle));
    if (pull < 0) {
      EXPECT_LT(std::abs(cluster->state(0).x.x() - before), 1e-9);
    } else {
      EXPECT_NEAR(cluster->state(0).x.x(), 50 * pull, 0.01 * 50 * pull);
    }
  }
}

TEST(SteppedCluster, a_block_brakes_over_the_distance_of_its_friction) {
  double last = 1;
  for (const double rate : {240.0, 960.0}) {
    Scene scene;
    scene.add_ground();
    scene.settings.step = 1 / rate;
    scene.add_box(Vec3(0.4, 0.4, 0.2), 1000, Vec3(0, 0, 0.1)).v.x() = 3;
    const auto cluster = scene.start();
    advance(*cluster, 3);
    const double exact = 9 / (2 * 0.5 * g), error = std::abs(cluster->state(0).x.x() / exact - 1);
    EXPECT_LT(error, 2e-5);
    EXPECT_LT(error, 0.5 * last);
    last = error;
  }
}

// A belt that runs along x.
class Belt : public Trajectory {
 public:
  explicit Belt(double speed) : speed_(speed) {}
  Pose pose(double time) const override { return {Vec3(speed_ * time, 0, 0), Quat::Identity()}; }
  Twist twist(double) const override { return {Vec3(speed_, 0, 0), Vec3::Zero()}; }
  MotionBounds bounds(double, double) const override { return MotionBounds::unknown(); }

 private:
  double speed_;
};

TEST(SteppedCluster, a_belt_takes_along_what_lies_on_it) {
  Scene scene;
  const auto belt = std::make_shared<Belt>(2);
  scene.outside.push_back({make_box(Vec3(20, 2, 0.2)), {Vec3(0, 0, 0), Quat::Identity()}, belt});
  scene.add_box(Vec3(0.4, 0.4, 0.2), 1000, Vec3(0, 0, 0.2));
  const auto cluster = scene.start();
  advance(*cluster, 0.25);
  EXPECT_NEAR(cluster->state(0).v.x(), 0.5 * g * 0.25, 1e-3);
  advance(*cluster, 2);
  // it lags behind by what it took to get as fast
  EXPECT_NEAR(cluster->state(0).v.x(), 2, 1e-9);
  EXPECT_NEAR(cluster->state(0).x.x(), 4 - 4 / (2 * 0.5 * g), 4e-3);
  EXPECT_NEAR(cluster->state(0).x.z(), 0.2, 1e-4);
}

TEST(SteppedCluster, a_ball_bounces_by_its_restitution) {
  Scene scene;
  scene.add_ground();
  scene.law.restitution = 0.8;
  scene.add(make_sphere(0.1), 1000, Vec3(0, 0, 1.1), 0.2);
  const auto cluster = scene.start();
  double highest = 0;
  for (double last = -1; cluster->time() < 2;) {
    cluster->advance();
    const double v = cluster->state(0).v.z();
    if (last > 0 && v <= 0 && highest == 0) highest = cluster->state(0).x.z() - 0.1;
    last = v;
  }
  EXPECT_NEAR(highest, 0.64, 0.01);
}

// 27 bricks that fly at each other in free space: momentum and what is lost of angular momentum.
struct Meeting {
  Vec3 momentum, turning;
  double energy = 0;
  std::uint64_t contacts = 0;
};
Meeting meet(double step) {
  Scene scene;
  scene.gravity.setZero();
  scene.law.restitution = 0.3;
  scene.settings.step = step;
  Random random(3);
  const auto any = [&] { return Vec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)); };
  for (int i = 0; i < 27; ++i) {
    const Vec3 place(i % 3, i / 3 % 3, i / 9);
    const Vec3 x = 0.5 * place + 0.02 * any();
    StepMember& brick = scene.add_box(Vec3(0.2, 0.3, 0.25), 500, x);
    brick.v = -2 * (x - Vec3::Constant(0.5)) + 0.3 * any();
    brick.w = any();
  }
  const auto cluster = scene.start();
  const auto sums = [&] {
    Meeting sum{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t i = 0; i < scene.members.size(); ++i) {
      const StepMember& member = scene.members[i];
      const PoseTwist at = cluster->state(static_cast<int>(i));
      const Mat3 R = at.q.toRotationMatrix();
      sum.momentum += member.mass * at.v;
      sum.turning += member.mass * at.x.cross(at.v) + R * (member.inertia * (R.transpose() * at.w));
    }
    sum.energy = energy(scene, *cluster);
    return sum;
  };
  const Meeting before = sums();
  advance(*cluster, 1);
  const Meeting after = sums();
  return {after.momentum - before.momentum, after.turning - before.turning,
          after.energy - before.energy, cluster->counts().contacts};
}

TEST(SteppedCluster, momentum_of_what_meets_in_free_space_is_kept) {
  const Meeting coarse = meet(1.0 / 240), fine = meet(1.0 / 1920);
  EXPECT_GT(coarse.contacts, 100u);
  EXPECT_LT(coarse.momentum.norm(), 1e-12);
  EXPECT_LT(coarse.energy, 0);
  // arms are those of a step's start: first order
  EXPECT_LT(coarse.turning.norm(), 0.1);
  EXPECT_LT(fine.turning.norm(), 0.25 * coarse.turning.norm());
}

TEST(SteppedCluster, a_pyramid_stands) {
  Scene scene;
  scene.add_ground();
  scene.settings.step = 1.0 / 480;
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10 - row; ++i)
      scene.add_box(Vec3::Constant(0.2), 1000, Vec3(0.21 * (i + 0.5 * row), 0, 0.1 + 0.2 * row));
  const auto cluster = scene.start();
  advance(*cluster, 5);
  for (std::size_t i = 0; i < scene.members.size(); ++i) {
    const PoseTwist at = cluster->state(static_cast<int>(i));
    EXPECT_LT((at.x - scene.members[i].x).norm(), 5e-4) << i;
    EXPECT_LT(at.v.norm(), 1e-9) << i;
  }
}

TEST(SteppedCluster, steps_are_halved_until_the_depth_holds) {
  const auto deepest = [](int halvings) {
    Scene scene;
    scene.add_ground();
    scene.settings.step = 1.0 / 120;
    scene.settings.depth = 2e-3;
    scene.settings.halvings = halvings;
    for (int i = 0; i < 20; ++i) {
      StepMember& cube = scene.add_box(Vec3::Constant(0.3), 1000,
                                       Vec3(0.2 * (i % 2), 0.2 * (i % 3), 0.5 + 0.5 * i));
      cube.v.z() = -5;
      cube.w = Vec3(1, 2, i);
    }
    const auto cluster = scene.start();
    advance(*cluster, 3);
    if (halvings > 0) {
      EXPECT_GT(cluster->counts().halvings, 3u);
    }
    return cluster->deepest();
  };
  EXPECT_LT(deepest(5), 1.5 * 2e-3);
  EXPECT_GT(deepest(0), 3 * 2e-3);
}

}  // namespace
}  // namespace tw
