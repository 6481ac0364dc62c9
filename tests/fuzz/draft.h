// A scene while it is being drawn: its random numbers, its units and what many kinds need.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>

#include "base/random.h"
#include "fuzz/described-scene.h"

namespace tw::fuzz {

class Draft {
 public:
  // Draws size, gravity, friction, restitution and accuracy.
  Draft(const std::string& kind, std::uint64_t seed);

  Random random;
  DescribedScene scene;
  double size = 1;   // m
  double speed = 1;  // m/s: sqrt(g size), with the standard g where there is no gravity
  double time = 1;   // s: size over speed

  bool chance(double share) { return random.real() < share; }
  int whole(int least, int most);
  double log_uniform(double least, double most);
  Vec3 vector(double most);
  Vec3 direction();
  Quat attitude();

  // No gravity from here on, with the same units.
  void float_freely() { scene.gravity = Vec3::Zero(); }
  // How long, in time units.
  void last(double units) { scene.duration = units * time; }

  // Named after their numbers; returns it.
  std::size_t add(DescribedBody body, const std::string& name);
  std::size_t add_fixed(const Solid& solid, const Vec3& position,
                        const Quat& orientation = Quat::Identity());
  DescribedBody& add_moving(std::vector<Solid> solids, const Vec3& position);

  // A solid or a union that fits into a ball of this diameter about the origin.
  std::vector<Solid> shape(double diameter);
  std::vector<Solid> union_shape(double diameter);
  // Round parts that meet flush along z, in a circle at `seam`; unions of such parts.
  std::vector<Solid> flush_rod(double radius, double length, double& seam);
  std::vector<Solid> flush_shape(double diameter);
  Solid rock(double diameter, int points);
  // A capsule, cone, ellipsoid or cylinder.
  Solid round_shape(double diameter);
  // A rod, needle, plate or coin, thinner by 1:100 to 1:1000 than its diameter.
  Solid thin_shape(double diameter);

  // Ground z = 0 and four walls `half` away: half-spaces, or boxes that overlap below the ground,
  // or boxes that stand on it.
  void add_pit(double half, double height);
  // Random bodies in layers of cells of `cell` metres, within `half` of the axis, from `bottom` up;
  // of solids from `make`.
  template <class Make>
  void pour(int count, double half, double bottom, double cell, Make make);
  // Attitude and a speed of up to this many speed units.
  void toss(DescribedBody& body, double speeds);
};

template <class Make>
void Draft::pour(int count, double half, double bottom, double cell, Make make) {
  const int across = std::max(1, static_cast<int>(2 * half / cell));
  for (int k = 0; k < count; ++k) {
    const Vec3 number(k % across, k / across % across, k / (across * across));
    const Vec3 corner(-0.5 * cell * (across - 1), -0.5 * cell * (across - 1), bottom + 0.5 * cell);
    toss(add_moving(make(), corner + cell * number), 0.3);
  }
}

}  // namespace tw::fuzz
