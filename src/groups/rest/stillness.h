// How long a body has hardly moved: the book that rest is decided by (rest.h).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"
#include "timeline/key.h"

namespace tw {

// The watch over one member.  It doubles for as long as nothing can be said: its first half is then
// the whole of what was seen.
struct Stillness {
  double since = never;                  // s; `never`: it is not slow
  double length = 0;                     // of the watch, s
  double early_peak = 0, late_peak = 0;  // m/s, in the halves of the watch
  Vec3 x = Vec3::Zero();                 // where it was at `since`
  Quat q = Quat::Identity();
};

}  // namespace tw
