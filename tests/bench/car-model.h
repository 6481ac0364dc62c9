// The car of car-bench, in numbers that every engine is given, and the same car in MuJoCo.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "math/vec.h"

namespace tw::bench {

// Seven bodies: chassis, two steering knuckles in front, four wheels.  m, kg, N m, s.
struct CarModel {
  Vec3 chassis{2.7, 1.0, 0.4}, knuckle{0.12, 0.1, 0.16};  // edges
  double chassis_mass = 486, knuckle_mass = 4, wheel_mass = 32;
  double radius = 0.36, width = 0.26;           // of a wheel
  double axle = 0.9, track = 0.72, drop = 0.1;  // of the wheels from the chassis' middle
  bool balls = false;                           // for wheels
  double friction = 0.9;
  double drive = 200;                              // N m s/rad on each wheel
  double steering = 2e4, steering_damping = 1500;  // of a knuckle
  double tick = 0.02;                              // of the controller

  double height() const { return radius + drop; }
  // What the controller asks for at a tick.
  double wheel_speed(double time) const { return 15 * std::min(time, 1.0); }
  double angle(double time) const { return 0.25 * std::sin(1.2 * time); }
};

#ifdef TW_MUJOCO
// Where the chassis is after the duration, m, by Euler's method with implicit joint damping.
std::optional<Vec3> run_mujoco_car(const CarModel& car, double step, double duration);
#else
inline std::optional<Vec3> run_mujoco_car(const CarModel&, double, double) { return std::nullopt; }
#endif

}  // namespace tw::bench
