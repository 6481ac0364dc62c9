// What the bodies of an impulse solver move with.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/LU>

#include "dynamics/impulse-solver.h"

namespace tw::test {

// Kinetic energy of what impulses move, J.
inline double energy(const ImpulseSolver& solver) {
  double sum = 0;
  for (std::uint32_t i = 0; i < solver.slot_count(); ++i) {
    const ImpulseSlot& s = solver.slot(i);
    if (s.moves())
      sum +=
          0.5 * (s.v.squaredNorm() / s.inverse_mass + s.w.dot(s.inverse_inertia.inverse() * s.w));
  }
  return sum;
}

}  // namespace tw::test
