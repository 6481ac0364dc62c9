// Numbers at random, the same ones each time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <random>

#include "math/vec.h"

namespace tw::test {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  // From lo to hi, as many in each decade.
  double decades(double lo, double hi) { return std::exp(between(std::log(lo), std::log(hi))); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  bool coin() { return below(2) == 0; }
  // In a cube of twice that edge.
  Vec3 cube(double radius) { return radius * Vec3(between(-1, 1), between(-1, 1), between(-1, 1)); }
  Quat turn() {
    return Quat(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
  }

 private:
  std::mt19937 engine_;
};

}  // namespace tw::test
