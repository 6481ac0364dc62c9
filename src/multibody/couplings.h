// Joints that follow others: a follower's position is a linear function of its leader's,
//   q_f = r q_l + q_0,  so that  u_f = r u_l.
//
// As equations G u = 0, one row each with 1 at the follower and -r at the leader; as a map u = T v,
// v the velocities of all that lead, with G T = 0.  What holds them does no work: with M u' = f of
// the joints by themselves,
//   u' = M^-1 f - W (G W)^-1 G M^-1 f,  W = M^-1 G^T,
// and so for all that M^-1 answers; or T^T M T v' = T^T f.  Since both equations are linear,
// methods of Runge, Kutta and Rosenbrock keep them to rounding.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), section 3.2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "math/vec.h"
#include "multibody/coordinates.h"
#include "multibody/spatial.h"

namespace tw::multibody {

// u_f = r u_l of a row of velocities or displacements (nv).
void follow(const Tree& tree, Out row);
// The same of positions (nq).
void follow_positions(const Tree& tree, Out q);
// T^T of a row of torques: the leaders' take the followers', which become 0.
void fold(const Tree& tree, Out row);
// T^T A T (nv x nv, by columns) in place, with 1 for the followers on the diagonal.
void fold_matrix(const Tree& tree, Out columns);

// W and what it moves, of a factored tree; nothing where none follows.
struct CouplingFactors {
  Eigen::MatrixXd W;                       // nv x couplings
  std::vector<std::vector<Motion>> moved;  // by coupling: the nodes by W
  Eigen::MatrixXd inverse;                 // (G W)^-1

  // What is to be taken from these velocities, as shares of W.
  Eigen::VectorXd excess(const Tree& tree, In u) const;
};

// Takes it from velocities, or rates of them, and from the motions of the nodes.
void take_excess(const Tree& tree, const CouplingFactors& factors, Out u,
                 std::span<Motion> motions);

}  // namespace tw::multibody
