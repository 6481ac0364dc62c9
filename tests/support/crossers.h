// What slides and rolls over the joints of a floor: bodies 0.2 m high.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/shape.h"

namespace tw::test {

struct Crosser {
  const char* name;
  ShapePtr shape;
  double friction;
  Vec3 spin;
};

inline std::vector<Crosser> crossers() {
  return {{"box", make_box({0.3, 0.25, 0.2}), 0, Vec3::Zero()},
          {"box with friction", make_box({0.3, 0.25, 0.2}), 0.1, Vec3::Zero()},
          {"sliding ball", make_sphere(0.1), 0, Vec3::Zero()},
          {"rolling ball", make_sphere(0.1), 0.5, {0, 30, 0}},
          {"standing cylinder", make_cylinder(0.15, 0.2), 0.1, Vec3::Zero()}};
}

}  // namespace tw::test
