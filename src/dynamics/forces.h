// Forces that act on a rigid body as a function of time and of what the body does.
//
// Weight and the constant applied force are not among them: they alone leave the body's flight in
// closed form.
//
// Frames: all vectors in the world frame; torques about the centre of mass; rotations and their
// changes as short rotation vectors.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/never.h"
#include "dynamics/ids.h"
#include "dynamics/pose-twist.h"

namespace tw {

struct Wrench {
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m
};

// Of force (rows 0 to 2) and torque (3 to 5) by position and rotation, and by velocity and angular
// velocity.
struct WrenchDerivative {
  Mat6 by_pose = Mat6::Zero();
  Mat6 by_twist = Mat6::Zero();
};

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
  // Whether another body holds the other end.
  virtual bool hangs_on(BodyId /*other*/) const { return false; }
  // Of its parameters: the same in every run.
  virtual std::uint64_t hash() const = 0;
};

using ForceLawPtr = std::shared_ptr<const ForceLaw>;

// What acts on a body beside weight and applied force; immutable, shared by states.
class ActingForces {
 public:
  ActingForces(const Vec3& torque, std::vector<ForceLawPtr> laws)
      : torque_(torque), laws_(std::move(laws)) {}

  const Vec3& torque() const { return torque_; }  // applied, constant
  const std::vector<ForceLawPtr>& laws() const { return laws_; }
  Wrench wrench(double time, const PoseTwist& body) const;
  WrenchDerivative derivative(double time, const PoseTwist& body) const;
  double energy(double time, const PoseTwist& body) const;
  double longest_unlooked() const;
  std::uint64_t hash() const;

 private:
  Vec3 torque_;
  std::vector<ForceLawPtr> laws_;
};

using ForcesPtr = std::shared_ptr<const ActingForces>;

// The same with another torque, or another law; null where nothing is left.
ForcesPtr with_torque(const ForcesPtr& forces, const Vec3& torque);
ForcesPtr with_law(const ForcesPtr& forces, ForceLawPtr law);
ForcesPtr without_those_on(const ForcesPtr& forces, BodyId other);

// The derivative of a law that knows none of its own, by central differences over a small share of
// the length and of the speed, both > 0.
void add_differences(const ForceLaw& law, double time, const PoseTwist& body, double length,
                     double speed, WrenchDerivative& sum);

// Drag at the centre of mass: -(linear + quadratic |v|) v, N s/m and N s^2/m^2, not negative.
ForceLawPtr make_drag(double linear, double quadratic);

// A spring between two points: along u from one to the other, at distance l,
//   stiffness (l - rest) + damping u.dv;
// with rest = 0, where u has no direction at l = 0, stiffness d + damping dv as vectors.
struct SpringLaw {
  double stiffness = 0;  // N/m
  double damping = 0;    // N s/m
  double rest = 0;       // m

  // On the near point; d, dv: the far point's place and velocity against it.
  Vec3 force(const Vec3& d, const Vec3& dv) const;
  void derivative(const Vec3& d, const Vec3& dv, Mat3& by_d, Mat3& by_dv) const;
  double energy(const Vec3& d) const;
  std::uint64_t hash() const;
};

// Adds what a force f at the arm r from the centre of mass does, and its derivative: f depends on
// the far point's place and velocity against the near one by the two matrices.
void add_force_at(const Vec3& r, const Vec3& f, Wrench& sum);
void add_derivative_at(const Vec3& r, const Vec3& w, const Vec3& f, const Mat3& by_d,
                       const Mat3& by_dv, WrenchDerivative& sum);

}  // namespace tw
