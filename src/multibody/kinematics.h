// Where all links of a multibody are, how they move, and what acts on them.
//
// `place` fills a Kinematics, a work space that is made once for a tree; all that comes after reads
// it: dynamics, derivatives, Jacobians, impulses, energy.  Between the two a caller may add
// wrenches to links, from forces that depend on where they are.
//
// Frames: world axes; r, motions and forces are about the point `origin`.  By default that is the
// base's origin, or a free first link's; trees that are coupled must be placed about the same one.
//
// Cost: about a third of a forward dynamics; sines are most of it.
//
// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), tables 5.1 and 9.3.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "multibody/coordinates.h"

namespace tw::multibody {

// Gravity, and the base with its motion; all in the world.
struct BaseMotion {
  Vec3 gravity = Vec3::Zero();                  // m/s^2
  Frame base;                                   // m
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();      // of the base's origin, m/s; rad/s
  Vec3 a = Vec3::Zero(), alpha = Vec3::Zero();  // their rates
};

// One node: frame, velocity, acceleration.
struct NodeMotion {
  Mat3 R;        // node to world
  Vec3 r;        // its frame's origin less `origin`, m
  Motion V;      // velocity
  Motion A;      // acceleration less gravity's, were all u' 0: (w'; rate of v at the fixed point)
  Vec3 center;   // of mass, less `origin`
  Sym3 moments;  // about it, world axes
  Force W;       // wrench from outside

  RigidBodyInertia inertia(double mass) const {
    return RigidBodyInertia::about(mass, center, moments);
  }
};

class Kinematics {
 public:
  explicit Kinematics(const Tree& tree);

  NodeMotion& node(int i) { return nodes[static_cast<std::size_t>(i)]; }
  const NodeMotion& node(int i) const { return nodes[static_cast<std::size_t>(i)]; }
  // Motion of a node by dof k, per unit of u_k.
  Motion& axis(int k) { return axes[static_cast<std::size_t>(k)]; }
  const Motion& axis(int k) const { return axes[static_cast<std::size_t>(k)]; }

  Vec3 origin = Vec3::Zero();  // m, in the world
  std::vector<NodeMotion> nodes;
  std::vector<Motion> axes;
};

// Fills `k` from q (nq, unit quaternions) and u (nv); wrenches are 0 then.  Base and gravity stand
// still or move as they are given.
void place(const Tree& tree, In q, In u, const BaseMotion& around, Kinematics& k);
// The same about a given origin.
void place(const Tree& tree, In q, In u, const BaseMotion& around, const Vec3& origin,
           Kinematics& k);

// Of a link's frame, in the world: m; m/s of its origin, rad/s.
Frame link_frame(const Tree& tree, const Kinematics& k, int link);
struct LinkTwist {
  Vec3 v, w;
};
LinkTwist link_twist(const Tree& tree, const Kinematics& k, int link);
// m, in the world.
Vec3 link_center_of_mass(const Tree& tree, const Kinematics& k, int link);

// Adds a force at a point, N and m, and a torque, N m, to what acts on a link; world.  On links
// that are welded to the base they have no effect.
void add_force(const Tree& tree, Kinematics& k, int link, const Vec3& point, const Vec3& force);
void add_torque(const Tree& tree, Kinematics& k, int link, const Vec3& torque);

}  // namespace tw::multibody
