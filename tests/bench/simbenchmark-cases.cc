// The rigid-body tests of SimBenchmark as cases for any engine.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "base/random.h"
#include "bench/made-cases.h"

namespace tw::bench {

namespace {

using test::CaseBody;
using test::CaseTable;

CaseBody ground() {
  CaseBody body;
  body.shape = "plane";
  body.fixed = true;
  return body;
}

// Balls roll: the first of them is the third body.
void fill_rolling(CaseTable& c, const test::Numbers3& force) {
  constexpr int side = 5;
  c.duration = 4;
  c.friction = 0.8;
  c.bodies[0].friction = 0.4;
  c.bodies.push_back(solid_box({10, 10, 0.5}, 10, {0, 0, 0.5}));
  c.bodies.back().force = force;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      c.bodies.push_back(solid_ball(0.5, 1, {2.0 * i - 4, 2.0 * j - 4, 1.5}));
}

void fill_bouncing(CaseTable& c) {
  c.duration = 20;
  c.restitution = 1;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 7; ++j) c.bodies.push_back(solid_ball(0.1, 10, {2.0 * i, 2.0 * j, 5}));
}

// A lattice, each ball shifted at random by up to 1 mm along each axis.
void fill_666(CaseTable& c, double restitution, double height) {
  constexpr double gap = 0.21, most = 1e-3;
  c.duration = 10;
  c.restitution = restitution;
  Random random(42);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        const double x = gap * i + random.real(0, most), y = gap * j + random.real(0, most);
        const double z = gap * k + random.real(0, most) + height;
        c.bodies.push_back(solid_ball(0.1, 10, {x, y, z}));
      }
}

// Toy planks of 120 x 24 x 8 mm.  The middles of a ring's planks are `radius` from the axis, and
// cross those of the next ring, turned by half a plank, radius tan(pi/16) from their middles.
void fill_kapla(CaseTable& c) {
  constexpr int rings = 6, planks = 8;
  constexpr double pi = 3.14159265358979323846;
  constexpr double half_length = 0.06, half_width = 0.004, half_height = 0.012, mass = 0.014;
  constexpr double radius = 0.2;
  c.duration = 10;
  c.friction = 0.5;
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < planks; ++k) {
      const double angle = 2 * pi / planks * (k + 0.5 * (ring % 2));
      CaseBody plank = solid_box(
          {half_width, half_length, half_height}, mass,
          {radius * std::cos(angle), radius * std::sin(angle), half_height * (2 * ring + 1)});
      plank.orientation = {std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle)};
      c.bodies.push_back(plank);
    }
}

}  // namespace

CaseTable simbenchmark_case(const std::string& name) {
  constexpr double push = 150;
  CaseTable c;
  c.name = name;
  c.gravity = {0, 0, -9.81};
  c.restitution = 0;
  c.bodies.push_back(ground());
  if (name == "rolling") fill_rolling(c, {0, push, 0});
  if (name == "rolling-diagonal") fill_rolling(c, {0.5 * push, std::sqrt(0.75) * push, 0});
  if (name == "bouncing") fill_bouncing(c);
  if (name == "elastic-666") fill_666(c, 1, 1.101);
  if (name == "666") fill_666(c, 0, 0.101);
  if (name == "kapla") fill_kapla(c);
  return c;
}

}  // namespace tw::bench
