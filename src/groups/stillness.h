// How long somebody has hardly moved: what rest and sleep are decided by.
//
// Speeds are those of the fastest surface point, m/s.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"
#include "timeline/key.h"

namespace tw {

// The book of one member.
struct Stillness {
  double since = never;             // s; `never`: it is not still
  double early_peak = 0, peak = 0;  // in the first and in the second half of the watch
  Vec3 x = Vec3::Zero();            // where it was at `since`
  Quat q = Quat::Identity();
};

// The book of a whole group: slow, and nothing slips.
struct QuietTime {
  double since = never;  // s; `never`: not so
  double speed = 0;      // at that time
};

}  // namespace tw
