// The recursive Newton-Euler algorithm, and the composite-rigid-body algorithm.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/inverse-dynamics.h"

#include <algorithm>

namespace tw::multibody {

InverseDynamics::InverseDynamics(const Tree& tree)
    : acceleration(static_cast<std::size_t>(tree.node_count())),
      force(acceleration.size()),
      composite(acceleration.size()) {}

void inverse_dynamics(const Tree& tree, const Kinematics& k, In rate, InverseDynamics& work,
                      Out tau) {
  const int count = tree.node_count();
  work.force[world_node] = work.force[base_node] = Force();
  for (int i = first_node; i < count; ++i) {
    const Node& node = tree.node(i);
    const auto at = static_cast<std::size_t>(i);
    Motion a = work.acceleration[static_cast<std::size_t>(node.parent)];
    for (int d = node.u; d < node.u + node.dofs; ++d)
      a.add(k.axis(d), rate[static_cast<std::size_t>(d)]);
    work.acceleration[at] = a;
    work.force[at] = net_force(node.mass, k.node(i), k.node(i).A + a);
  }
  for (int i = count - 1; i >= first_node; --i) {
    const Node& node = tree.node(i);
    const Force& f = work.force[static_cast<std::size_t>(i)];
    for (int d = node.u; d < node.u + node.dofs; ++d)
      tau[static_cast<std::size_t>(d)] = dot(k.axis(d), f);
    work.force[static_cast<std::size_t>(node.parent)] += f;
  }
}

void mass_matrix(const Tree& tree, const Kinematics& k, InverseDynamics& work, Out M) {
  const int count = tree.node_count();
  const auto n = static_cast<std::size_t>(tree.nv());
  std::fill(M.begin(), M.end(), 0.0);
  for (int i = first_node; i < count; ++i)
    work.composite[static_cast<std::size_t>(i)] = k.node(i).inertia(tree.node(i).mass);
  for (int i = count - 1; i >= first_node; --i) {
    const Node& node = tree.node(i);
    const RigidBodyInertia& I = work.composite[static_cast<std::size_t>(i)];
    for (int d = node.u + node.dofs - 1; d >= node.u; --d) {
      const Force f = I * k.axis(d);
      const auto row = static_cast<std::size_t>(d);
      for (int e = d; e >= 0; e = tree.dof_parent(e)) {
        const auto column = static_cast<std::size_t>(e);
        M[row + n * column] = M[column + n * row] = dot(k.axis(e), f);
      }
    }
    if (node.parent >= first_node) work.composite[static_cast<std::size_t>(node.parent)] += I;
  }
}

}  // namespace tw::multibody
