// How long a member of a group has hardly moved.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"
#include "timeline/key.h"

namespace tw {

// Speeds are those of the fastest surface point, m/s.
struct Stillness {
  double since = never;             // s; `never`: it is not calm
  double early_peak = 0, peak = 0;  // in the first and in the second half of the watch
  Vec3 x = Vec3::Zero();            // where it was at `since`
  Quat q = Quat::Identity();
};

}  // namespace tw
