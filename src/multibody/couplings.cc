// Joints that follow others.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/couplings.h"

#include <Eigen/LU>

#include "base/index.h"

namespace tw::multibody {

void follow(const Tree& tree, Out row) {
  for (const Coupling& c : tree.couplings())
    row[index(c.follower)] = c.ratio * row[index(c.leader)];
}

void follow_positions(const Tree& tree, Out q) {
  for (const Coupling& c : tree.couplings())
    q[index(c.follower_q)] = c.ratio * q[index(c.leader_q)] + c.offset;
}

void fold(const Tree& tree, Out row) {
  for (const Coupling& c : tree.couplings()) {
    row[index(c.leader)] += c.ratio * row[index(c.follower)];
    row[index(c.follower)] = 0;
  }
}

void fold_matrix(const Tree& tree, Out columns) {
  if (tree.couplings().empty()) return;
  const int n = tree.nv();
  Eigen::Map<Eigen::MatrixXd> A(columns.data(), n, n);
  for (const Coupling& c : tree.couplings()) {
    A.col(c.leader) += c.ratio * A.col(c.follower);
    A.row(c.leader) += c.ratio * A.row(c.follower);
    A.col(c.follower).setZero();
    A.row(c.follower).setZero();
    A(c.follower, c.follower) = 1;
  }
}

Eigen::VectorXd CouplingFactors::excess(const Tree& tree, In u) const {
  Eigen::VectorXd broken(static_cast<Eigen::Index>(tree.couplings().size()));
  Eigen::Index row = 0;
  for (const Coupling& c : tree.couplings())
    broken[row++] = u[index(c.follower)] - c.ratio * u[index(c.leader)];
  return inverse * broken;
}

void take_excess(const Tree& tree, const CouplingFactors& factors, Out u,
                 std::span<Motion> motions) {
  const Eigen::VectorXd shares = factors.excess(tree, u);
  Eigen::Map<Eigen::VectorXd>(u.data(), tree.nv()) -= factors.W * shares;
  for (std::size_t g = 0; g < factors.moved.size(); ++g)
    for (std::size_t i = index(first_node); i < motions.size(); ++i)
      motions[i].add(factors.moved[g][i], -shares[static_cast<Eigen::Index>(g)]);
  // to the last bit
  follow(tree, u);
}

}  // namespace tw::multibody
