// Motions and forces of described scenes that are procedures of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "fuzz/procedures.h"

#include <cmath>

#include "integrate/given/sampled-motion.h"

namespace tw::fuzz {
namespace {

class SwingProcedure final : public MotionProcedure {
 public:
  SwingProcedure(const DescribedBody& body, const Shape& shape)
      : name_(body.name),
        middle_(body.pose),
        swing_(*body.swing),
        size_(shape.least_width()),
        radius_(shape.radius_about_origin()) {}

  std::string name() const override { return "the motion of " + name_; }
  Pose pose(double time) const override { return swing_.pose(middle_, time); }
  void require_speed(double, const Pose&, double, const Pose&) const override {}
  double max_speed() const override { return swing_.max_speed(radius_); }
  double size() const override { return size_; }
  double radius() const override { return radius_; }

 private:
  std::string name_;
  Pose middle_;
  Swing swing_;
  double size_, radius_;
};

class DescribedProcedure final : public ForceProcedure {
 public:
  DescribedProcedure(const DescribedForce& force, std::uint64_t number)
      : force_(force), number_(number) {}

  std::uint64_t number() const override { return number_; }
  Wrench force(double time, const BodyState& body) override {
    const Vec3 pull = force_.stiffness * (force_.place - body.position);
    return {pull + std::sin(2 * pi / force_.period * time) * force_.push,
            -force_.resistance * body.angular_velocity};
  }

 private:
  DescribedForce force_;
  std::uint64_t number_;
};

}  // namespace

TrajectoryPtr make_swing(const DescribedBody& body, const Shape& shape) {
  return std::make_shared<SampledMotion>(std::make_unique<SwingProcedure>(body, shape));
}

std::shared_ptr<ForceProcedure> make_force(const DescribedForce& force, std::uint64_t number) {
  return std::make_shared<DescribedProcedure>(force, number);
}

}  // namespace tw::fuzz
