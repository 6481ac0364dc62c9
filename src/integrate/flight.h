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
  Flight(const FreeRotation& rotation, const Parabola& path) : rotation_(rotation), path_(path) {}

  Pose pose(double time) const override;
  Twist twist(double time) const override;
  PoseTwist at(double time) const override;
  // The path over all time is unbounded.
  MotionBounds bounds(double from, double to) const override;
  const Parabola* ballistic() const override { return &path_; }
  const Parabola& path() const { return path_; }

 private:
  FreeRotation rotation_;
  Parabola path_;  // last: beside what predictions read of a state
};

}  // namespace tw
