// A gas as a case for any engine.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "bench/event-driven-md.h"
#include "bench/made-cases.h"

namespace tw::bench {

namespace {

constexpr double duration = 2;    // s
constexpr double density = 1000;  // kg/m^3, as in the tables

test::Numbers3 numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// A half-space whose outward normal, along an axis or against it, points into the cube.
test::CaseBody wall(int axis, bool far, double side) {
  const double half = std::sqrt(0.5), sign = far ? -1 : 1;
  test::CaseBody body;
  body.shape = "plane";
  body.fixed = true;
  if (far) body.position[static_cast<std::size_t>(axis)] = side;
  // what turns z to the normal
  if (axis == 0) body.orientation = {half, 0, sign * half, 0};
  if (axis == 1) body.orientation = {half, -sign * half, 0, 0};
  if (axis == 2 && far) body.orientation = {0, 1, 0, 0};
  return body;
}

}  // namespace

test::CaseTable gas_case(int count) {
  const Gas gas = make_gas(count);
  test::CaseTable c;
  c.name = "gas-" + std::to_string(count);
  c.restitution = 1;
  c.duration = duration;
  const double volume = 4.0 / 3 * pi * gas.radius * gas.radius * gas.radius;
  for (std::size_t i = 0; i < gas.position.size(); ++i) {
    c.bodies.push_back(solid_ball(gas.radius, density * volume, numbers(gas.position[i])));
    c.bodies.back().velocity = numbers(gas.velocity[i]);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) c.bodies.push_back(wall(axis, far, gas.side));
  return c;
}

std::vector<std::vector<double>> gas_result(int count) {
  EventDrivenMd md(make_gas(count));
  md.advance(duration);
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < count; ++i) {
    const Vec3 x = md.position(i), v = md.velocity(i);
    rows.push_back({static_cast<double>(i), x.x(), x.y(), x.z(), v.x(), v.y(), v.z()});
  }
  return rows;
}

}  // namespace tw::bench
