// Torques that a motion needs: the recursive Newton-Euler algorithm, and the mass matrix.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), sections 5.3 and 6.2.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/kinematics.h"

namespace tw::multibody {

// Work space, made once for a tree.
class InverseDynamics {
 public:
  explicit InverseDynamics(const Tree& tree);

  std::vector<Motion> acceleration;         // by node
  std::vector<Force> force;                 // by node: through its joint; base: on the links
  std::vector<RigidBodyInertia> composite;  // by node, with all beyond it as one body
};

// The force that a node of acceleration A (less gravity's) needs beyond what acts on it from
// outside: Newton and Euler about its centre of mass.
inline Force net_force(double mass, const NodeMotion& node, const Motion& A) {
  const Vec3& c = node.center;
  const Vec3 &w = node.V.w, v = node.V.v + w.cross(c);
  const Vec3 f = mass * (A.v + A.w.cross(c) + w.cross(v));
  const Vec3 n = node.moments * A.w + w.cross(node.moments * w);
  return {n + c.cross(f) - node.W.n, f - node.W.f};
}

// tau (nv) = M u' - (gravity, Coriolis terms, wrenches on links), as placed.  What laws at the
// joints contribute (joint-laws.h) is part of tau.
void inverse_dynamics(const Tree& tree, const Kinematics& k, In rate, InverseDynamics& work,
                      Out tau);

// M (nv x nv), column by column, both triangles: by composite rigid bodies.  Entries of dofs that
// are on no common way to the base are 0.
void mass_matrix(const Tree& tree, const Kinematics& k, InverseDynamics& work, Out M);

}  // namespace tw::multibody
