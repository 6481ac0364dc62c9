// The articulated-body algorithm.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/forward-dynamics.h"

#include <Eigen/LU>

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

namespace {

// du (nv) = M^-1 e, e the row of G of a coupling; the motions of the nodes by it.
void answer_to(const Tree& tree, const Kinematics& k, const Articulation& a, const Coupling& c,
               Eigen::Ref<Eigen::VectorXd> du, std::vector<Motion>& moved) {
  std::vector<Force> force(a.inertia.size());
  for (int i = tree.node_count() - 1; i >= first_node; --i) {
    const Node& node = tree.node(i);
    Force& F = force[static_cast<std::size_t>(i)];
    for (int d = node.u + node.dofs - 1; d >= node.u; --d) {
      const double given = d == c.follower ? 1 : d == c.leader ? -c.ratio : 0;
      du[d] = dot(k.axis(d), F) + given;
      F.add(a.dof(d).U, -du[d] * a.dof(d).inverse_D);
    }
    force[static_cast<std::size_t>(node.parent)] += F;
  }
  moved.assign(force.size(), Motion());
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    Motion change = moved[static_cast<std::size_t>(node.parent)];
    for (int d = node.u; d < node.u + node.dofs; ++d) {
      du[d] = (du[d] - dot(change, a.dof(d).U)) * a.dof(d).inverse_D;
      change.add(k.axis(d), du[d]);
    }
    moved[static_cast<std::size_t>(i)] = change;
  }
}

void factor_couplings(const Tree& tree, const Kinematics& k, Articulation& a) {
  const auto count = static_cast<Eigen::Index>(tree.couplings().size());
  if (count == 0) return;
  CouplingFactors& f = a.couplings;
  f.W.resize(tree.nv(), count);
  f.moved.resize(tree.couplings().size());
  Eigen::MatrixXd GW(count, count);
  for (Eigen::Index g = 0; g < count; ++g)
    answer_to(tree, k, a, tree.couplings()[static_cast<std::size_t>(g)], f.W.col(g),
              f.moved[static_cast<std::size_t>(g)]);
  for (Eigen::Index g = 0; g < count; ++g) {
    const Coupling& c = tree.couplings()[static_cast<std::size_t>(g)];
    GW.row(g) = f.W.row(c.follower) - c.ratio * f.W.row(c.leader);
  }
  f.inverse = GW.inverse();
}

}  // namespace

bool factor(const Tree& tree, const Kinematics& k, Articulation& a) {
  const bool regular = sweep_inward<false>(tree, k, nullptr, a);
  factor_couplings(tree, k, a);
  return regular;
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
  if (tree.couplings().empty()) return regular;
  factor_couplings(tree, k, a);
  take_excess(tree, a.couplings, rate, a.acceleration);
  return regular;
}

}  // namespace tw::multibody
