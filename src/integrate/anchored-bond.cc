// A spring or a hold to what stands or moves as it was given.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/anchored-bond.h"

#include "base/constants.h"

namespace tw {
namespace {

class AnchoredBond final : public ForceLaw {
 public:
  AnchoredBond(const Bond& bond, TrajectoryPtr motion, bool stands)
      : bond_(bond), motion_(std::move(motion)), stands_(stands) {
    if (stands_) place_ = motion_->at(0);
  }

  void add(double time, const PoseTwist& body, Wrench& sum) const override {
    const Wrench on_body = bond_.wrenches(anchor(time), body).b;
    sum.force += on_body.force;
    sum.torque += on_body.torque;
  }
  void add_derivative(double time, const PoseTwist& body, WrenchDerivative& sum) const override {
    const WrenchDerivative own = bond_.derivative(anchor(time), body).of[1][1];
    sum.by_pose += own.by_pose;
    sum.by_twist += own.by_twist;
  }
  double energy(double time, const PoseTwist& body) const override {
    return bond_.energy(anchor(time), body);
  }
  double longest_unlooked() const override { return stands_ ? never : answer::motion_span; }
  const Bond* bond() const override { return &bond_; }
  std::uint64_t hash() const override { return bond_.hash(); }

 private:
  PoseTwist anchor(double time) const { return stands_ ? place_ : motion_->at(time); }

  Bond bond_;
  TrajectoryPtr motion_;
  bool stands_;
  PoseTwist place_;  // of the anchor, where it stands
};

}  // namespace

ForceLawPtr make_anchored_bond(const Bond& bond, TrajectoryPtr motion, bool stands) {
  return std::make_shared<AnchoredBond>(bond, std::move(motion), stands);
}

}  // namespace tw
