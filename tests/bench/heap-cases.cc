// Heaps that are kept moving, as cases for any engine: boxes and balls, which all of them know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "base/random.h"
#include "bench/made-cases.h"

namespace tw::bench {

namespace {

using test::CaseBody;
using test::CaseTable;
using test::Numbers3;

constexpr double density = 1000;             // kg/m^3
constexpr double least = 0.05, most = 0.08;  // m: half edges and radii
constexpr double spacing = 0.28;  // m: no two that are most large meet, however they turn

// A uniformly random rotation (Shoemake).
std::array<double, 4> random_rotation(Random& random) {
  constexpr double turn = 2 * 3.14159265358979323846;
  const double u = random.real(), a = turn * random.real(), b = turn * random.real();
  return {std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
          std::sqrt(u) * std::sin(b), std::sqrt(u) * std::cos(b)};
}

// Every other one is a ball.
void add_loose(CaseTable& c, Random& random, const Numbers3& position) {
  const auto half = [&] { return random.real(least, most); };
  if (c.bodies.size() % 2 == 0) {
    const double r = half();
    c.bodies.push_back(
        solid_ball(r, density * 4 / 3 * 3.14159265358979323846 * r * r * r, position));
    return;
  }
  const Numbers3 edges{half(), half(), half()};
  c.bodies.push_back(solid_box(edges, density * 8 * edges[0] * edges[1] * edges[2], position));
  c.bodies.back().orientation = random_rotation(random);
}

void add_wall(CaseTable& c, const Numbers3& half_edges, const Numbers3& position,
              double angle = 0) {
  CaseBody wall = solid_box(half_edges, 0, position);
  wall.orientation = {std::cos(0.5 * angle), 0, std::sin(0.5 * angle), 0};
  wall.driven = true;
  c.bodies.push_back(wall);
}

// Sixteen staves about the y axis between two plates.
void fill_drum(CaseTable& c) {
  constexpr int staves = 16;
  constexpr double turn = 2 * 3.14159265358979323846;
  constexpr double radius = 1, thick = 0.1, half_length = 0.45;
  c.motion.axis = {0, 1, 0};
  c.motion.rate = 2;
  const double half_width = (radius + 2 * thick) * std::tan(0.5 * turn / staves);
  for (int k = 0; k < staves; ++k) {
    // turned by this about y, x is (cos, 0, -sin)
    const double angle = turn * k / staves, away = radius + thick;
    add_wall(c, {thick, half_length, half_width},
             {away * std::cos(angle), 0, -away * std::sin(angle)}, angle);
  }
  for (const double side : {-1.0, 1.0})
    add_wall(c, {1.2 * radius, thick, 1.2 * radius}, {0, side * (half_length + thick), 0});
  Random random(1);
  for (int i = -3; i <= 3; ++i)
    for (int k = -3; k <= 3; ++k)
      for (int j = -1; j <= 1; ++j) {
        const Numbers3 at{spacing * i, spacing * j, spacing * k};
        if (std::hypot(at[0], at[2]) < radius - 0.15) add_loose(c, random, at);
      }
}

// A floor, four walls and a lid.
void fill_shaken(CaseTable& c) {
  constexpr double half = 0.6, height = 2, thick = 0.1;
  c.motion.swing = {0.1, 0, 0};
  c.motion.frequency = 2.5;
  for (const double z : {-thick, height + thick})
    add_wall(c, {half + 2 * thick, half + 2 * thick, thick}, {0, 0, z});
  for (const double side : {-1.0, 1.0}) {
    const double away = side * (half + thick);
    add_wall(c, {thick, half + 2 * thick, 0.5 * height}, {away, 0, 0.5 * height});
    add_wall(c, {half + 2 * thick, thick, 0.5 * height}, {0, away, 0.5 * height});
  }
  Random random(1);
  for (int k = 0; k < 5; ++k)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        add_loose(c, random, {spacing * (i - 1.5), spacing * (j - 1.5), 0.2 + spacing * k});
}

}  // namespace

CaseTable heap_case(const std::string& name) {
  CaseTable c;
  c.name = name;
  c.gravity = {0, 0, -9.81};
  c.restitution = 0.2;
  c.friction = 0.5;
  c.duration = 5;
  name == "drum" ? fill_drum(c) : fill_shaken(c);
  return c;
}

}  // namespace tw::bench
