// The articulated-body algorithm.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/forward-dynamics.h"

#include "multibody/inverse-dynamics.h"

namespace tw::multibody {
namespace {

template <bool with_forces>
bool sweep_inward(const Tree& tree, const Kinematics& k, const double* tau, Articulation& a) {
  const int count = tree.node_count();
  for (int i = first_node; i < count; ++i) {
    a.inertia_of(i).set(k.node(i).inertia(tree.node(i).mass));
    if (with_forces) a.bias_of(i) = net_force(tree.node(i).mass, k.node(i), k.node(i).A);
  }
  bool regular = true;
  for (int i = count - 1; i >= first_node; --i) {
    const Node& node = tree.node(i);
    ArticulatedInertia& I = a.inertia_of(i);
    Force& p = a.bias_of(i);
    for (int d = node.u + node.dofs - 1; d >= node.u; --d) {
      const Motion& S = k.axis(d);
      Articulation::Dof& dof = a.dof(d);
      dof.U = I * S;
      const double D = dot(S, dof.U);
      regular = regular && D > 0;
      dof.inverse_D = 1 / D;
      I.add_square(dof.U, -dof.inverse_D);
      if (with_forces) {
        dof.t = tau[d] - dot(S, p);
        p.add(dof.U, dof.t * dof.inverse_D);
      }
    }
    if (node.parent >= first_node) {
      a.inertia_of(node.parent) += I;
      if (with_forces) a.bias_of(node.parent) += p;
    }
  }
  return regular;
}

}  // namespace

Articulation::Articulation(const Tree& tree)
    : inertia(static_cast<std::size_t>(tree.node_count())),
      bias(inertia.size()),
      acceleration(inertia.size()),
      dofs(static_cast<std::size_t>(tree.nv())) {}

bool factor(const Tree& tree, const Kinematics& k, Articulation& a) {
  return sweep_inward<false>(tree, k, nullptr, a);
}

bool forward_dynamics(const Tree& tree, const Kinematics& k, In tau, Articulation& a, Out rate) {
  const bool regular = sweep_inward<true>(tree, k, tau.data(), a);
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    Motion acceleration = a.acceleration_of(node.parent);
    for (int d = node.u; d < node.u + node.dofs; ++d) {
      const Articulation::Dof& dof = a.dof(d);
      const double value = (dof.t - dot(acceleration, dof.U)) * dof.inverse_D;
      acceleration.add(k.axis(d), value);
      rate[static_cast<std::size_t>(d)] = value;
    }
    a.acceleration_of(i) = acceleration;
  }
  return regular;
}

}  // namespace tw::multibody
