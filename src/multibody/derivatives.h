// The derivative of a multibody's equation of motion, for implicit integration.
//
// With the residual f(z, u) - M(z) a at fixed accelerations a (those at the step's start), z a
// displacement in the chart of coordinates.h,
//   Kq = d/dz [f - M a],   Ku = d/du f,   so that   du'/dz = M^-1 Kq,   du'/du = M^-1 Ku.
// For dof k of node i with parent p, S its axis, V and A velocity and acceleration (less
// gravity's):
//   P = V_p x S,  Q = A_p x S + V_p x P,  X = P + V_i x S,
//   d tau_i/dz_j = S_i.(2B P_j + I Q_j),   d tau_j/dz_i = S_j.(2B P_i + I Q_i + S_i x* F),
//   d tau_i/du_j = S_i.(2B S_j + I X_j),   d tau_j/du_i = S_j.(2B S_i + I X_i)
// for j on the way from i to the base, with composites I, 2B, F of the links from i on.  Within one
// joint S_i x* F is left out, since the axes of a spherical joint turn along.
//
// Of a free link with the velocity (v, w) of its origin, in the world: moving on, P = Q = X = 0
// (everything comes along); turning, V_p and A_p are the link's own, X = V x S + (0; v x e), and
// S x* F counts within the joint too, since its axes don't turn along.
//
// Wrenches on links that depend on motion enter by link, not by contact: with dW = X dx + Y dV
// under a rigid displacement dx of the link and a change dV of its velocity, both about the origin,
// L = X - Y [V x], Y and W are summed towards the base as I is, and
//   dtau_j/dz_k = S_j.(L S_k + Y P_k) [+ (S_k x S_j).W, k nearer to the base],
//   dtau_j/du_k = S_j.(Y S_k).
//
// Cost: O(nv times depth); about two forward dynamics for a car.
//
// Source: S. Singh, R. Russell, P. Wensing, Efficient analytical derivatives of rigid-body dynamics
// using spatial vector algebra, IEEE RA-L 7 (2022), with world (v, w) of free links added.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/inverse-dynamics.h"

namespace tw::multibody {

// How the wrench on a link depends on its motion; order (torque, force) by (turn, shift), about the
// origin.  N m and N by rad and m, or rad/s and m/s.
struct ForceDerivative {
  Mat6 by_displacement = Mat6::Zero(), by_velocity = Mat6::Zero();
};

// Work space, made once for a tree.
class Linearisation {
 public:
  explicit Linearisation(const Tree& tree);

  // 0 for all links; then adds of one.
  void clear_wrenches();
  void add_wrench(const Tree& tree, int link, const ForceDerivative& derivative);

  // By node.
  struct NodeTerms {
    RigidBodyInertia I;
    CoriolisMatrix B;
    Force F, W;
    Mat6 L, Y;
    Motion A;
    bool wrench = false, wrench_beyond = false;
  };
  std::vector<NodeTerms> nodes;
  // By dof: P, Q, X.
  struct DofTerms {
    Motion P, Q, X;
  };
  std::vector<DofTerms> dofs;
  std::vector<ForceDerivative> wrenches;

  NodeTerms& node(int i) { return nodes[static_cast<std::size_t>(i)]; }
  DofTerms& dof(int k) { return dofs[static_cast<std::size_t>(k)]; }
  const DofTerms& dof(int k) const { return dofs[static_cast<std::size_t>(k)]; }
};

// M, Kq and Ku, nv x nv, column by column, as placed, at the accelerations `rate` (nv), with the
// wrenches' derivatives that were added; laws at the joints are added by add_joint_derivatives.
// Entries of dofs that are on no common way to the base are 0.
void linearise(const Tree& tree, const Kinematics& k, In rate, Linearisation& work, Out M, Out Kq,
               Out Ku);

// Adds what a wrench on link a, of tree A, owes to the motion of link b, of tree B (or of the same
// tree; a force between two links has four such terms, those on the diagonal by add_wrench):
// entry (j, k) of Kq and Ku, with `stride` between columns, rows of A, columns of B.  Both are
// placed about one origin and linearised.
struct Side {
  const Tree& tree;
  const Kinematics& k;
  const Linearisation& work;
  int link;
};
void add_cross_derivative(const Side& a, const Side& b, const ForceDerivative& derivative,
                          std::size_t stride, double* Kq, double* Ku);

}  // namespace tw::multibody
