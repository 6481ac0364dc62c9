// The base of a multibody: where it stands, or how it moves with the body that it is fixed to.
//
// Joint velocities are against the base.  Where its velocity jumps, V to V + dV, no impulse acts
// along the joints, and they change as in no time under the acceleration dV:
//   du = -M^-1 P dV,   P dV the momentum that all links gain along the joints as they are carried.
// The velocity that u is against stands in the state (MultibodyState::base), so that a jump counts
// once.  Arcs end where it jumps; a jump within one would be missed.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/trajectory.h"
#include "multibody/kinematics.h"
#include "multibody/multibody.h"

namespace tw {

class MovingBase {
 public:
  // `end`: of an arc on it, for steps that reach beyond: at a corner there what comes before
  // counts, and goes on by its accelerations.
  explicit MovingBase(const Multibody& multibody, double end = never)
      : multibody_(&multibody), end_(end) {}

  bool moves() const { return multibody_->base_motion != nullptr; }
  // All but gravity.
  void set(double time, multibody::BaseMotion& around) const;
  // As `set` has it; and just before.
  Twist twist(double time) const;
  Twist twist_before(double time) const;
  MotionRates most_rates(double from, double to) const;

 private:
  double inside(double time) const;
  const Trajectory& motion() const { return *multibody_->base_motion; }

  const Multibody* multibody_;
  double end_;
};

// When its velocity jumps first in (from, to], or its motion fails; `never`: it does not.
double next_corner_of(const Multibody& multibody, double from, double to);

// The joints after the jump to the velocity that the base has at `time`, if there is one.
void follow_base(const Multibody& multibody, double time, MultibodyState& joints);

}  // namespace tw
