// The motion of one isolated body on which more acts than weight and a constant force: torques,
// drag, springs, forces by procedures; made step by step, with dense output.
//
// y = (x, theta, v, L), with theta the rotation vector from the step's start and L the angular
// momentum, so that no gyroscopic term appears; the chart is the attitude at the step's start:
//   x' = v,  theta' = Jl(theta)^-1 w,  v' = a + F/m,  L' = T,  w = R I^-1 R^T L,
//   R = exp(theta) R0.
// Poses follow the polynomials of x and theta, which are continuous with their rates; velocities
// follow those of v and L.
//
// Errors of a step are held to accuracy/20 of a body's size and of a radian, and of its speeds: the
// polynomial errs by up to 13 times what a step does (doc/numerics/driven-motion.md).
//
// Bounds come from the control points of the polynomials (dense-step.h) and hold by themselves.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <exception>
#include <string>

#include "base/error.h"
#include "dynamics/forces.h"
#include "integrate/explicit/solution.h"
#include "integrate/trajectory.h"

namespace tw {

// The body, how its arc begins, and what acts on it.
struct DrivenStart {
  double time = 0;
  double mass = 1;
  Vec3 moments = Vec3::Ones();
  double size = 1;      // m, the unit of errors
  double gravity = 1;   // m/s^2, > 0: the scale of what is slow
  double accuracy = 1;  // relative
  Vec3 x = Vec3::Zero();
  Quat q = Quat::Identity();
  Vec3 v = Vec3::Zero();
  Vec3 L = Vec3::Zero();
  Vec3 acceleration = Vec3::Zero();    // constant: gravity and applied force
  ForcesPtr forces;                    // null: none
  const RungeKutta* method = nullptr;  // null: by the accuracy
  std::string name;                    // for messages
  Place place;
};

class DrivenArc final : public Trajectory {
 public:
  explicit DrivenArc(const DrivenStart& start);

  Pose pose(double time) const override;
  Twist twist(double time) const override;
  PoseTwist at(double time) const override;
  // Beyond where it failed it stands.
  MotionBounds bounds(double from, double to) const override;
  double turn_change_across(const Vec3& n, double from, double to,
                            const MotionBounds& known) const override;
  // Where it failed, as far as that is known yet.
  double end() const override;
  double step_end(double time) const override;
  bool stepped() const override { return true; }
  Effort effort() const override;
  Vec3 free_acceleration(double time) const override;
  void halt(double time) const override;
  std::exception_ptr failure() const override { return failure_; }

 private:
  // The step that holds the time; null: it failed before, and stands.  Where it was halted that is
  // the one before, or `beyond`, the next.
  const DenseStep* step_at(double time, bool beyond = false) const;
  Quat attitude(const DenseStep& step, const Vec3& theta) const;
  void add_step_bounds(const DenseStep& step, double from, double to, MotionBounds& bounds) const;

  double mass_;
  Vec3 inverse_moments_, acceleration_;
  ForcesPtr forces_;
  PoseTwist start_;
  std::string name_;
  Place place_;
  mutable Solution solution_;
  mutable std::exception_ptr failure_;
};

}  // namespace tw
