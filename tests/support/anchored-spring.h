// Springs to what stands or moves, for tests of what drives a body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/anchored-bond.h"
#include "integrate/standing.h"

namespace tw::test {

// From `arm` of the body to the point of the anchor.
inline ForceLawPtr spring_to(const TrajectoryPtr& anchor, const Vec3& point, const Vec3& arm,
                             const SpringLaw& law) {
  Bond bond;
  bond.a = 3;
  bond.b = 4;
  bond.arm_a = point;
  bond.arm_b = arm;
  bond.spring = law;
  return make_anchored_bond(bond, anchor, false);
}
inline ForceLawPtr spring_to(const Vec3& place, const Vec3& arm, const SpringLaw& law) {
  Bond bond;
  bond.arm_b = arm;
  bond.spring = law;
  return make_anchored_bond(bond, make_standing({place, Quat::Identity()}), true);
}

}  // namespace tw::test
