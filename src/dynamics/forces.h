// Forces that act on a rigid body as a function of time and of what the body does.
//
// Weight and the constant applied force are not among them: they alone leave the body's flight in
// closed form.
//
// Frames: dynamics/wrench.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/never.h"
#include "dynamics/bond.h"
#include "dynamics/ids.h"
#include "dynamics/pose-twist.h"
#include "dynamics/wrench.h"

namespace tw {

class ForceLaw {
 public:
  virtual ~ForceLaw() = default;
  // Pure: same arguments, same bits.
  virtual void add(double time, const PoseTwist& body, Wrench& sum) const = 0;
  virtual void add_derivative(double time, const PoseTwist& body, WrenchDerivative& sum) const = 0;
  // Stored in it, J.
  virtual double energy(double /*time*/, const PoseTwist& /*body*/) const { return 0; }
  // How long it may go on without a look at it, s: where it changes with time by itself.
  virtual double longest_unlooked() const { return never; }
  // Of a spring or hold to what is not dynamic; else null.
  virtual const Bond* bond() const { return nullptr; }
  // Of its parameters: the same in every run.
  virtual std::uint64_t hash() const = 0;
};

using ForceLawPtr = std::shared_ptr<const ForceLaw>;

// What acts on a body beside weight and applied force; immutable, shared by states.
class ActingForces {
 public:
  ActingForces() = default;
  ActingForces(const Vec3& torque, std::vector<ForceLawPtr> laws)
      : torque_(torque), laws_(std::move(laws)) {}

  const Vec3& torque() const { return torque_; }  // applied, constant
  const std::vector<ForceLawPtr>& laws() const { return laws_; }
  // To other dynamic bodies: known to both, and no part of the sums below.
  const std::vector<BondPtr>& bonds() const { return bonds_; }
  // Whether a torque or a law acts.
  bool act_alone() const { return !laws_.empty() || !torque_.isZero(0); }
  Wrench wrench(double time, const PoseTwist& body) const;
  WrenchDerivative derivative(double time, const PoseTwist& body) const;
  double energy(double time, const PoseTwist& body) const;
  double longest_unlooked() const;
  std::uint64_t hash() const;

 private:
  friend class ForceChange;
  Vec3 torque_ = Vec3::Zero();
  std::vector<ForceLawPtr> laws_;
  std::vector<BondPtr> bonds_;
};

using ForcesPtr = std::shared_ptr<const ActingForces>;

// The same with another torque, another law or bond; null where nothing is left.
ForcesPtr with_torque(const ForcesPtr& forces, const Vec3& torque);
ForcesPtr with_law(const ForcesPtr& forces, ForceLawPtr law);
ForcesPtr with_bond(const ForcesPtr& forces, BondPtr bond);
// Whether a spring or a hold goes to the body, or a hold joins the two.
bool hangs_on(const ForcesPtr& forces, BodyId body);
bool holds(const ForcesPtr& forces, BodyId a, BodyId b);
// Whether a spring or a hold ties it to another dynamic body, or a hold, which is stiff, to any:
// the body is then integrated in a group, implicitly.
bool needs_group(const ForcesPtr& forces);
// Without springs and holds to the body, or without what holds the two.
ForcesPtr without_those_on(const ForcesPtr& forces, BodyId body);
ForcesPtr without_holds(const ForcesPtr& forces, BodyId a, BodyId b);
// Whether this law or bond is among them; the same without it.
bool has(const ForcesPtr& forces, const void* law_or_bond);
ForcesPtr without(const ForcesPtr& forces, const void* law_or_bond);

inline const std::vector<BondPtr>& bonds_of(const ForcesPtr& forces) {
  static const std::vector<BondPtr> none;
  return forces ? forces->bonds() : none;
}

// The derivative of a law that knows none of its own, by central differences over a small share of
// the length and of the speed, both > 0.
void add_differences(const ForceLaw& law, double time, const PoseTwist& body, double length,
                     double speed, WrenchDerivative& sum);

// Drag at the centre of mass: -(linear + quadratic |v|) v, N s/m and N s^2/m^2, not negative.
ForceLawPtr make_drag(double linear, double quadratic);

}  // namespace tw
