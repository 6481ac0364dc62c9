// Accelerations of a multibody's joints from forces: the articulated-body algorithm.
//
// From the leaves to the base each dof k takes out of the inertia beyond it what can yield at it:
//   U = I S,  D = S.U,  I -= U U^T / D,  t = tau - S.p,  p += U t / D,
// with I the articulated inertia and p the force that is missing if all u' were 0; then from the
// base outward u'_k = (t - U.a)/D, a += S u'_k.  A joint of several dofs is so many in a row, for S
// is that of one instant.  Nothing is transformed on the way: all is about one point, in world
// axes.
//
// U and D are kept: they are M = L D L^T, and serve impulses (impulses.h).  Joints that follow
// others (couplings.h) have their part taken out at the end.
//
// Cost: O(nodes), so many times more as there are joints that follow, and one.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), section 7.3; the bias forces from
// accelerations at u' = 0 instead of those of one joint at a time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/couplings.h"
#include "multibody/kinematics.h"

namespace tw::multibody {

// Work space and result, made once for a tree.
class Articulation {
 public:
  explicit Articulation(const Tree& tree);

  // By node.
  std::vector<ArticulatedInertia> inertia;
  std::vector<Force> bias;
  std::vector<Motion> acceleration;
  // By dof: U, 1/D, t.
  struct Dof {
    Force U;
    double inverse_D = 0, t = 0;
  };
  std::vector<Dof> dofs;

  CouplingFactors couplings;  // of joints that follow others

  ArticulatedInertia& inertia_of(int node) { return inertia[static_cast<std::size_t>(node)]; }
  Force& bias_of(int node) { return bias[static_cast<std::size_t>(node)]; }
  Motion& acceleration_of(int node) { return acceleration[static_cast<std::size_t>(node)]; }
  Dof& dof(int k) { return dofs[static_cast<std::size_t>(k)]; }
  const Dof& dof(int k) const { return dofs[static_cast<std::size_t>(k)]; }
};

// u' (nv) from the torques at the joints `tau` (nv), gravity, velocities and the links' wrenches,
// as placed; keeps the factors.  True unless some D is not positive: the configuration leaves an
// acceleration undetermined, and u' is worth nothing.
bool forward_dynamics(const Tree& tree, const Kinematics& k, In tau, Articulation& a, Out rate);

// The factors alone.
bool factor(const Tree& tree, const Kinematics& k, Articulation& a);

}  // namespace tw::multibody
