// Multibodies for tests: chains of rods, a car of five bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/shape.h"
#include "kernel/world/world.h"
#include "multibody/multibody.h"
#include "support/scene.h"

namespace tw::test {

// Square rods along x, end to end, on hinges along y; angle 0 is level, pi/2 hangs.
inline MultibodyDef chain(int links, double length, const Vec3& position) {
  MultibodyDef def;
  def.name = "chain";
  def.position = position;
  for (int i = 0; i < links; ++i) {
    LinkDef link;
    link.name = "rod-" + std::to_string(i);
    if (i > 0) link.parent = "rod-" + std::to_string(i - 1);
    link.joint.axis = Vec3::UnitY();
    if (i > 0) link.joint.placement.p = Vec3(length, 0, 0);
    link.body.shape = place_shape(make_box(Vec3(length, 0.1 * length, 0.1 * length)),
                                  Pose{Vec3(0.5 * length, 0, 0), Quat::Identity()});
    def.links.push_back(link);
  }
  return def;
}

constexpr double wheel_radius = 0.25, car_height = 0.4;

// A chassis along x on four wheels; on level ground its frame is at car_height.
inline MultibodyDef car(const Vec3& position) {
  MultibodyDef def;
  def.name = "car";
  def.free = true;
  def.position = position;
  LinkDef chassis;
  chassis.name = "chassis";
  chassis.body.shape = make_box(Vec3(1.6, 0.8, 0.3));
  def.links.push_back(chassis);
  const Quat sideways(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
  for (int i = 0; i < 4; ++i) {
    LinkDef wheel;
    wheel.name = "wheel-" + std::to_string(i);
    wheel.parent = "chassis";
    wheel.joint.axis = Vec3::UnitY();
    wheel.joint.placement.p = Vec3(i < 2 ? 0.6 : -0.6, i % 2 == 0 ? 0.55 : -0.55, -0.15);
    wheel.body.shape = place_shape(make_cylinder(wheel_radius, 0.2), Pose{Vec3::Zero(), sideways});
    def.links.push_back(wheel);
  }
  return def;
}

inline void set_joint(World& world, std::uint32_t multibody, std::size_t coordinate, double q) {
  world.edit(world.multibody(multibody).links[0], [&](StateView& view) {
    view.change_joints([&](MultibodyState& joints) { joints.q[coordinate] = q; });
  });
}
inline void set_velocity(World& world, std::uint32_t multibody, std::size_t freedom, double u) {
  world.edit(world.multibody(multibody).links[0], [&](StateView& view) {
    view.change_joints([&](MultibodyState& joints) { joints.u[freedom] = u; });
  });
}

}  // namespace tw::test
