// Forces on a rigid body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/forces.h"

#include <algorithm>

#include "base/hash.h"

namespace tw {
namespace {

class Drag final : public ForceLaw {
 public:
  Drag(double linear, double quadratic) : linear_(linear), quadratic_(quadratic) {}

  void add(double, const PoseTwist& body, Wrench& sum) const override {
    sum.force -= (linear_ + quadratic_ * body.v.norm()) * body.v;
  }
  // d(|v| v) = |v| dv + v v.dv/|v|
  void add_derivative(double, const PoseTwist& body, WrenchDerivative& sum) const override {
    const double speed = body.v.norm();
    auto block = sum.by_twist.topLeftCorner<3, 3>();
    block.diagonal().array() -= linear_ + quadratic_ * speed;
    if (speed > 0) block -= quadratic_ / speed * body.v * body.v.transpose();
  }
  std::uint64_t hash() const override {
    Hasher h;
    h.add(linear_);
    h.add(quadratic_);
    return h.value();
  }

 private:
  double linear_, quadratic_;
};

}  // namespace

Wrench ActingForces::wrench(double time, const PoseTwist& body) const {
  Wrench sum;
  sum.torque = torque_;
  for (const ForceLawPtr& law : laws_) law->add(time, body, sum);
  return sum;
}

WrenchDerivative ActingForces::derivative(double time, const PoseTwist& body) const {
  WrenchDerivative sum;
  for (const ForceLawPtr& law : laws_) law->add_derivative(time, body, sum);
  return sum;
}

double ActingForces::energy(double time, const PoseTwist& body) const {
  double sum = 0;
  for (const ForceLawPtr& law : laws_) sum += law->energy(time, body);
  return sum;
}

double ActingForces::longest_unlooked() const {
  double least = never;
  for (const ForceLawPtr& law : laws_) least = std::min(least, law->longest_unlooked());
  return least;
}

std::uint64_t ActingForces::hash() const {
  Hasher h;
  for (int i = 0; i < 3; ++i) h.add(torque_[i]);
  for (const ForceLawPtr& law : laws_) h.add(law->hash());
  for (const BondPtr& bond : bonds_) h.add(bond->hash());
  return h.value();
}

// A copy to be changed, and given back as what states share.
class ForceChange {
 public:
  explicit ForceChange(const ForcesPtr& forces) {
    if (forces) changed_ = *forces;
  }
  Vec3& torque() { return changed_.torque_; }
  std::vector<ForceLawPtr>& laws() { return changed_.laws_; }
  std::vector<BondPtr>& bonds() { return changed_.bonds_; }
  template <class Goes>
  void erase_bonds(Goes&& goes) {
    std::erase_if(laws(),
                  [&](const ForceLawPtr& law) { return law->bond() && goes(*law->bond()); });
    std::erase_if(bonds(), [&](const BondPtr& bond) { return goes(*bond); });
  }
  ForcesPtr done() {
    if (!changed_.act_alone() && changed_.bonds_.empty()) return nullptr;
    return std::make_shared<ActingForces>(std::move(changed_));
  }

 private:
  ActingForces changed_;
};

ForcesPtr with_torque(const ForcesPtr& forces, const Vec3& torque) {
  ForceChange change(forces);
  change.torque() = torque;
  return change.done();
}

ForcesPtr with_law(const ForcesPtr& forces, ForceLawPtr law) {
  ForceChange change(forces);
  change.laws().push_back(std::move(law));
  return change.done();
}

ForcesPtr with_bond(const ForcesPtr& forces, BondPtr bond) {
  ForceChange change(forces);
  change.bonds().push_back(std::move(bond));
  return change.done();
}

namespace {

template <class Test>
bool any_bond(const ForcesPtr& forces, Test&& test) {
  if (!forces) return false;
  for (const ForceLawPtr& law : forces->laws())
    if (law->bond() && test(*law->bond())) return true;
  return std::any_of(forces->bonds().begin(), forces->bonds().end(),
                     [&](const BondPtr& bond) { return test(*bond); });
}

}  // namespace

bool hangs_on(const ForcesPtr& forces, BodyId body) {
  return any_bond(forces, [&](const Bond& bond) { return bond.joins(body); });
}

bool holds(const ForcesPtr& forces, BodyId a, BodyId b) {
  return any_bond(forces, [&](const Bond& bond) { return bond.holds && bond.joins(a, b); });
}

bool needs_group(const ForcesPtr& forces) {
  if (!forces) return false;
  return !forces->bonds().empty() || any_bond(forces, [](const Bond& bond) { return bond.holds; });
}

ForcesPtr without_those_on(const ForcesPtr& forces, BodyId body) {
  ForceChange change(forces);
  change.erase_bonds([&](const Bond& bond) { return bond.joins(body); });
  return change.done();
}

ForcesPtr without_holds(const ForcesPtr& forces, BodyId a, BodyId b) {
  ForceChange change(forces);
  change.erase_bonds([&](const Bond& bond) { return bond.holds && bond.joins(a, b); });
  return change.done();
}

bool has(const ForcesPtr& forces, const void* law_or_bond) {
  if (!forces) return false;
  const auto is_it = [&](const auto& one) { return one.get() == law_or_bond; };
  return std::any_of(forces->laws().begin(), forces->laws().end(), is_it) ||
         std::any_of(forces->bonds().begin(), forces->bonds().end(), is_it);
}

ForcesPtr without(const ForcesPtr& forces, const void* law_or_bond) {
  ForceChange change(forces);
  const auto is_it = [&](const auto& one) { return one.get() == law_or_bond; };
  std::erase_if(change.laws(), is_it);
  std::erase_if(change.bonds(), is_it);
  return change.done();
}

void add_differences(const ForceLaw& law, double time, const PoseTwist& body, double length,
                     double speed, WrenchDerivative& sum) {
  // the cube root of rounding balances the error of the difference
  constexpr double share = 0x1p-17;
  const auto column = [&](Mat6& matrix, int j, double step, auto&& change) {
    Wrench w[2];
    for (const int side : {0, 1}) {
      PoseTwist moved = body;
      change(moved, side == 0 ? -step : step);
      law.add(time, moved, w[side]);
    }
    matrix.col(j).head<3>() += (w[1].force - w[0].force) / (2 * step);
    matrix.col(j).tail<3>() += (w[1].torque - w[0].torque) / (2 * step);
  };
  for (int i = 0; i < 3; ++i) {
    column(sum.by_pose, i, share * length, [&](PoseTwist& p, double s) { p.x[i] += s; });
    column(sum.by_pose, 3 + i, share,
           [&](PoseTwist& p, double s) { p.q = Quat(Eigen::AngleAxisd(s, Vec3::Unit(i))) * p.q; });
    column(sum.by_twist, i, share * speed, [&](PoseTwist& p, double s) { p.v[i] += s; });
    column(sum.by_twist, 3 + i, share * speed / length,
           [&](PoseTwist& p, double s) { p.w[i] += s; });
  }
}

ForceLawPtr make_drag(double linear, double quadratic) {
  return std::make_shared<Drag>(linear, quadratic);
}

}  // namespace tw
