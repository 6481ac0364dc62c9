// The stops of joints at a discontinuity.
//
// A stop is a contact of the joint with itself: what comes to it faster than its stop_speed is
// struck by an impulse (1+e) v / (M^-1)_kk at its coordinate, which moves all others by M^-1 e_k
// (of a spherical joint along n, by which its limited angle grows, with n.M^-1 n:
// multibody/limits.h); what is slower leans on it from there on, by the law of joint-laws.h, until
// it is found to have come off.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "multibody/multibody.h"

namespace tw {

// A stop that a joint leans on, pressed: of which axis, and the way out along what is limited.
struct LeaningStop {
  const multibody::Axis* axis = nullptr;
  double side = 0;  // 1 or -1
};
std::vector<LeaningStop> leaning_stops(const Multibody& multibody, const MultibodyState& joints);

// `may_leave`: whether what has come off its stop is let go.
void settle_stops(const Multibody& multibody, double now, bool may_leave, MultibodyState& joints);

}  // namespace tw
