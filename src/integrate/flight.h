// Free flight: a parabola and the torque-free rotation about its centre, both in closed form.
//
// Kept in the state itself, by value: an impact of two balls in a gas costs 2 us, and may not
// allocate.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "integrate/free-rotation.h"
#include "integrate/trajectory.h"

namespace tw {

class Flight final : public Trajectory {
 public:
  Flight() = default;
  // `turn_excess`: max |Ii - Ij| / Ik, for |w'| <= turn_excess |w|^2.
  Flight(const FreeRotation& rotation, double turn_excess, const Parabola& path)
      : rotation_(rotation), path_(path) {
    const double turn = rotation.max_angular_speed();
    turn_change_ = turn_excess * turn * turn;
  }

  Pose pose(double time) const override;
  Twist twist(double time) const override;
  PoseTwist at(double time) const override;
  // The path over all time is unbounded.
  MotionBounds bounds(double from, double to) const override;
  const Parabola* ballistic() const override { return &path_; }
  const Parabola& path() const { return path_; }

 private:
  FreeRotation rotation_;
  double turn_change_ = 0;  // bound on |w'|, rad/s^2
  Parabola path_;           // last: beside what predictions read of a state
};

}  // namespace tw
