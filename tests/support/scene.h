// A scene for tests: defined once, run under many schedules (schedule.h).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <functional>
#include <string>

#include "base/random.h"
#include "kernel/world/world.h"

namespace tw::test {

inline constexpr double g = 9.81;  // m/s^2

struct Scene {
  std::string name;
  double duration = 1;  // s
  std::function<void(World&)> fill;
};

// `make check-long` sets it: all seeds, all durations.
inline bool long_tests() {
  const char* set = std::getenv("TW_LONG_TESTS");
  return set && *set && std::string(set) != "0";
}

// Uniform in the cube [-most, most]^3; one call a component, so that the order is defined.
inline Vec3 random_vector(Random& random, double most) {
  const double x = random.real(-most, most), y = random.real(-most, most);
  const double z = random.real(-most, most);
  return {x, y, z};
}

inline Quat random_attitude(Random& random) {
  const Vec3 v = random_vector(random, 1);
  return Quat(random.real(-1, 1), v.x(), v.y(), v.z()).normalized();
}

inline void set_contact_for_all(World& world, double restitution, double friction) {
  ContactSettings settings;
  settings.restitution = restitution;
  settings.friction = friction;
  world.set_contact({}, {}, settings);
}

// A fixed half-space: solid behind the plane normal.x = offset.
inline BodyId add_wall(World& world, const Vec3& normal, double offset) {
  BodyDef def;
  def.shape = make_half_space(normal, offset);
  def.fixed = true;
  return world.add_body(def);
}

inline BodyId add_floor(World& world) {
  BodyDef def;
  def.name = "floor";
  def.shape = make_half_space(Vec3::UnitZ(), 0);
  def.fixed = true;
  return world.add_body(def);
}

// Six walls around [lo, hi]^3.
inline void add_walls(World& world, double lo, double hi) {
  for (int axis = 0; axis < 3; ++axis) {
    add_wall(world, Vec3::Unit(axis), lo);
    add_wall(world, -Vec3::Unit(axis), -hi);
  }
}

inline BodyDef body_of(const ShapePtr& shape, const Vec3& position, const Vec3& velocity,
                       const Vec3& angular_velocity = Vec3::Zero()) {
  BodyDef def;
  def.shape = shape;
  def.position = position;
  def.velocity = velocity;
  def.angular_velocity = angular_velocity;
  return def;
}

inline BodyId add_ball(World& world, double radius, const Vec3& position, const Vec3& velocity,
                       const Vec3& angular_velocity = Vec3::Zero()) {
  return world.add_body(body_of(make_sphere(radius), position, velocity, angular_velocity));
}

// The unit vector along an axis, either way: +-x, +-y, +-z.
inline Vec3 random_axis(Random& random) {
  const auto axis = static_cast<int>(random.below(3));
  const double sign = random.below(2) ? 1 : -1;
  return sign * Vec3::Unit(axis);
}

}  // namespace tw::test
