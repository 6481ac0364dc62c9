// Springs and holds: what pulls at a point of one body and a point of another, and turns a held
// pair back to the attitudes that it was held at.
//
// With the points p_a, p_b and d = p_b - p_a, b is pulled at p_b by -f(d, e), where e is the
// velocity of b there against that of a there, and a by f in the same place: so no bond changes the
// momentum or the angular momentum of the two, and damping never adds energy.  A hold adds the
// torque h k phi + sqrt(h) c (w_b - w_a) on a, its opposite on b, with the rotation vector phi of
// the attitude that b has against the one that a would have it at.
//
// Frames: of a dynamic body its principal frame at the centre of mass; of others the frame that
// their motion gives.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>

#include "dynamics/ids.h"
#include "dynamics/pose-twist.h"
#include "dynamics/second-hardening.h"
#include "dynamics/wrench.h"

namespace tw {

// A spring between two points: along u from one to the other, at distance l,
//   stiffness (l - rest) + damping u.dv;
// with rest = 0, where u has no direction at l = 0, stiffness d + damping dv as vectors, and where
// it hardens h stiffness d + sqrt(h) damping dv, h = 1 + H s^4 (dynamics/second-hardening.h).
struct SpringLaw {
  double stiffness = 0;  // N/m
  double damping = 0;    // N s/m
  double rest = 0;       // m

  // On the near point; d, dv: the far point's place and velocity against it.
  Vec3 force(const Vec3& d, const Vec3& dv, const SecondHardening& firm = {}) const;
  void derivative(const Vec3& d, const Vec3& dv, const SecondHardening& firm, Mat3& by_d,
                  Mat3& by_dv) const;
  double energy(const Vec3& d, const SecondHardening& firm = {}) const;
};

// How a held pair resists turning against each other.
struct TurnLaw {
  double stiffness = 0;              // N m/rad
  double damping = 0;                // N m s/rad
  Quat relative = Quat::Identity();  // of b in a's frame, where it turns nothing
};

struct Bond {
  BodyId a = no_body, b = no_body;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // of the points, in their frames
  SpringLaw spring;
  bool holds = false;  // by `turn`, too
  TurnLaw turn;
  SecondHardening firm = {}, firm_turn = {};  // of a hold

  // A hold that was not made to give way, by a stiffness of its own.
  bool is_firm() const { return holds && firm.firmness > 0; }
  BodyId other(BodyId body) const { return body == a ? b : a; }
  bool joins(BodyId body) const { return body == a || body == b; }
  bool joins(BodyId one, BodyId two) const {
    return (one == a && two == b) || (one == b && two == a);
  }

  struct Wrenches {
    Wrench a, b;
  };
  Wrenches wrenches(const PoseTwist& a, const PoseTwist& b) const;
  // of[i] by[j]: of the wrench on the one by what the other does; 0: a, 1: b.
  struct Derivative {
    WrenchDerivative of[2][2];
  };
  Derivative derivative(const PoseTwist& a, const PoseTwist& b) const;
  // Stored in it, J.
  double energy(const PoseTwist& a, const PoseTwist& b) const;
  // Of its numbers: the same in every run.
  std::uint64_t hash() const;
};

using BondPtr = std::shared_ptr<const Bond>;

}  // namespace tw
