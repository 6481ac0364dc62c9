// What impulses do to a multibody: inverse inertia at points, changes of all velocities.
//
// With M = L D L^T from the articulated inertias (forward-dynamics.h), L^-1 J^T takes one pass from
// the link to the base: columns F = [p x e; e]; at each dof on the way  y = S^T F,  F -= U y / D;
// J M^-1 J^T = sum of y y^T / D.  Nothing else of the tree is touched.  Two links share the dofs
// where their ways meet.
//
// All read a factored tree: forward_dynamics or factor.  Velocities don't enter.
//
// Cost: O(depth), but for velocity_change, O(nodes).
//
// Source: K. Lilly, Efficient Dynamic Simulation of Robotic Mechanisms (1993), section 5 (inverse
// operational-space inertia by one recursion); B. Mirtich, Impulse-based dynamic simulation of
// rigid body systems (1996), section 4.3.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "multibody/forward-dynamics.h"

namespace tw::multibody {

// A tree as placed and factored.
struct Factored {
  const Tree& tree;
  const Kinematics& k;
  const Articulation& a;
};

// K, 1/kg: change of velocity of a point of the link by a unit impulse there.  Positive
// semi-definite; of links with fewer than three freedoms singular.
Mat3 inverse_inertia(const Factored& f, int link, const Vec3& point);
// The same of velocity and turn (v, w) at the point by impulse and angular impulse (6 x 6).
Mat6 spatial_inverse_inertia(const Factored& f, int link, const Vec3& point);

// Of points on two links of one tree: velocities at a and b by impulses at a and b; ba = ab^T.
// Equal and opposite impulses see aa - ab - ab^T + bb.
struct InverseInertias {
  Mat3 aa, ab, bb;
};
InverseInertias inverse_inertias(const Factored& f, int a, const Vec3& point_a, int b,
                                 const Vec3& point_b);

// (M^-1)_kk: change of u_k by a unit generalised impulse there.
double inverse_inertia_of_dof(const Factored& f, int dof);

// An impulse, N s, at a point of a link, and an angular impulse, N m s; world.
struct LinkImpulse {
  int link = 0;
  Vec3 point = Vec3::Zero(), linear = Vec3::Zero(), angular = Vec3::Zero();
};

// Work space, made once for a tree.
class ImpulseWork {
 public:
  explicit ImpulseWork(const Tree& tree);

  std::vector<Force> impulse;  // by node
  std::vector<Motion> change;  // by node: of its velocity, about the origin
};

// du (nv) = M^-1 (sum of J^T impulse + generalised); `generalised` (nv) may be empty, and may be
// du.
void velocity_change(const Factored& f, std::span<const LinkImpulse> impulses, In generalised,
                     ImpulseWork& work, Out du);

}  // namespace tw::multibody
