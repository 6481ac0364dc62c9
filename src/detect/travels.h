// How bodies move over a window, as clearances see it.
//
// Cost: a body is asked for one stretch by each of its neighbours; within a batch of looks, during
// which no state changes, the answers are kept.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "dynamics/body.h"
#include "math/aabb.h"
#include "timeline/state.h"

namespace tw {

// Its centre goes along the chord of its path, evenly, but for what the path's bend takes it off
// (|x''| T^2/8 at most), and turning carries its surface beyond.  Where no accelerations are known,
// by the box of its path alone.  World frame, m.
struct Travel {
  Vec3 center = Vec3::Zero();  // where it begins
  Vec3 chord = Vec3::Zero();
  Aabb off{Vec3::Zero(), Vec3::Zero()};
  double turning = 0;
};

// A batch: for as long as it lives, states and their arcs stay as they are.
class Travels {
 public:
  Travels();
  // Of a body on the arc of its state, over [from, to].
  Travel of(const Body& body, const State& state, double from, double to) const;

 private:
  std::uint64_t batch_;  // no two share a number
};

}  // namespace tw
