// The chain of chain-bench in MuJoCo.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "math/vec.h"

namespace tw::bench {

inline constexpr double rod_length = 0.2, rod_mass = 0.2;  // m, kg
// Of a thin rod along x, kg m^2, a hundredth of it about its axis.
inline Vec3 rod_inertia() {
  const double across = rod_mass * rod_length * rod_length / 12;
  return {across / 100, across, across};
}

#ifdef TW_MUJOCO
// Where the tip is after the duration, m, by RK4 with that step, s.
std::optional<Vec3> run_mujoco_chain(int links, double step, double duration);
#else
inline std::optional<Vec3> run_mujoco_chain(int, double, double) { return std::nullopt; }
#endif

}  // namespace tw::bench
