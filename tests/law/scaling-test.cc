// A scene that is scaled gives the scaled motion: no rule knows a metre or a second of its own.
//
// Lengths by a power of 4 and times by its root keep gravity; lengths as they are and times by a
// power of 2 change it.  Powers of two, because group checks lie on a lattice of such: then all but
// rounding is the same, and the bodies part only as far as what is chaotic makes of rounding.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <functional>

#include "support/multibody-scenes.h"
#include "support/stability-scenes.h"

namespace tw::test {
namespace {

using FillScaled = std::function<void(World&, double length)>;

void fill_loose(World& world, double length) { scale_scene(length).fill(world); }

// An arm with friction at its joint falls onto its stop, where a slider at its end comes to a stop
// of its own and hits a cube on the floor.
void fill_jointed(World& world, double length, double friction) {
  const double torque = 1000 * std::pow(length, 4) * 9.81;
  add_floor(world);
  MultibodyDef def = chain(2, 0.5 * length, Vec3(0, 0, 0.8 * length));
  multibody::AxisSpec& hinge = def.links[0].joint.axes[0];
  hinge.friction = friction * torque;
  hinge.lower = -0.1;
  hinge.upper = 0.6;
  hinge.restitution = 0.4;
  multibody::JointSpec& slide = def.links[1].joint;
  slide.kind = multibody::JointKind::prismatic;
  slide.axis = Vec3::UnitX();
  slide.axes[0].lower = 0;
  slide.axes[0].upper = 0.2 * length;
  slide.axes[0].restitution = 0.6;
  world.add_multibody(def);
  BodyDef cube;
  cube.name = "cube";
  cube.shape = make_box(Vec3::Constant(0.2 * length));
  cube.position = Vec3(0.75, 0, 0.1) * length;
  world.add_body(cube);
}

// The farthest that a body is from where it should be, in sizes, over `units` of time.
double worst_deviation(const FillScaled& fill, double length, double time, double units) {
  World original, scaled;
  // before there is anything that it could change
  scaled.set_gravity(Vec3(0, 0, -9.81 * length / (time * time)));
  fill(original, 1);
  fill(scaled, length);
  double worst = 0;
  for (int i = 1; i <= 40; ++i) {
    const double when = units * i / 40;
    original.advance(when);
    scaled.advance(when * time);
    for (BodyId id = 1; id < static_cast<BodyId>(original.body_count()); ++id) {
      const Vec3 expected = original.state(id).position;
      worst = std::max(worst, (scaled.state(id).position / length - expected).norm());
    }
  }
  return worst;
}

// Until the drum tumbles nothing is chaotic but that the ball's blows on the stack share their
// impulses among more contacts than there are freedoms, to 1e-12; after that deviations are what
// the drum makes of rounding.
constexpr double before_chaos = 1e-6, after_chaos = 2e-3;

// Three cubes, ball, box and drum of 1 um to 1000 km fall on each other and come to rest.
TEST(Scaling, size_changes_nothing_but_the_unit) {
  for (const int k : {-10, -5, 5, 10}) {
    const double length = std::pow(4.0, k), time = std::pow(2.0, k);
    EXPECT_LT(worst_deviation(fill_loose, length, time, 1), before_chaos) << k;
    EXPECT_LT(worst_deviation(fill_loose, length, time, 10), after_chaos) << k;
  }
}

// Where a dry joint turns back rounding grows to what steps resolve.
TEST(Scaling, of_joints_with_stops_and_friction_too) {
  for (const double friction : {0., 2e-4})
    for (const int k : {-5, -3, 6}) {
      const double length = std::pow(4.0, k), time = std::pow(2.0, k);
      const auto fill = [&](World& world, double scale) { fill_jointed(world, scale, friction); };
      EXPECT_LT(worst_deviation(fill, length, time, 2), friction > 0 ? 1e-6 : 1e-9) << k;
    }
}

TEST(Scaling, speed_changes_no_joint) {
  const auto fill = [](World& world, double scale) { fill_jointed(world, scale, 0); };
  for (const int k : {-10, 8}) EXPECT_LT(worst_deviation(fill, 1, std::pow(2.0, k), 2), 1e-7) << k;
}

TEST(Scaling, speed_changes_nothing_but_the_unit) {
  for (const int k : {-10, 10}) {
    const double time = std::pow(2.0, k);
    EXPECT_LT(worst_deviation(fill_loose, 1, time, 1), before_chaos) << k;
    EXPECT_LT(worst_deviation(fill_loose, 1, time, 10), after_chaos) << k;
  }
}

}  // namespace
}  // namespace tw::test
