// Motions by functions of time, for tests: what a Scheme procedure is to the kernel.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>

#include "base/error.h"
#include "integrate/given/sampled-motion.h"

namespace tw::test {

// Of a body of 0.1 m, its farthest point 0.2 m from the origin.
class FunctionMotion final : public MotionProcedure {
 public:
  FunctionMotion(std::function<Pose(double)> function, double max_speed)
      : function_(std::move(function)), max_speed_(max_speed) {}

  std::string name() const override { return "a function"; }
  Pose pose(double time) const override {
    ++calls;
    earliest = std::min(earliest, time);
    latest = std::max(latest, time);
    return function_(time);
  }
  void require_speed(double from, const Pose& before, double to, const Pose& after) const override {
    TW_REQUIRE((after.p - before.p).norm() <= max_speed_ * (to - from) + 1e-12,
               "faster than " + show(max_speed_) + " m/s at " + show(from));
  }
  double max_speed() const override { return max_speed_; }
  double size() const override { return 0.1; }
  double radius() const override { return 0.2; }

  mutable long calls = 0;
  mutable double earliest = never, latest = -never;

 private:
  std::function<Pose(double)> function_;
  double max_speed_;
};

// The trajectory and, for as long as it lives, the procedure that it asks.
struct Sampled {
  const FunctionMotion* procedure;
  std::shared_ptr<const SampledMotion> motion;

  explicit Sampled(std::function<Pose(double)> function, double max_speed = 100) {
    auto owned = std::make_unique<FunctionMotion>(std::move(function), max_speed);
    procedure = owned.get();
    motion = std::make_shared<SampledMotion>(std::move(owned));
  }
};

}  // namespace tw::test
