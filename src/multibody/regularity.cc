// Whether a multibody's masses determine all its accelerations.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/regularity.h"

#include <algorithm>

#include "base/random.h"
#include "multibody/forward-dynamics.h"

namespace tw::multibody {
namespace {

constexpr int configurations = 3;
// D, what is left of the inertia beyond a joint when the joints there yield, over all of it: below
// this it is rounding.
constexpr double rounding = 1e-13;

// The dof of the first D, from the leaves, that is rounding; -1: none.
int lost_dof(const Tree& tree, const Kinematics& k, Articulation& a) {
  factor(tree, k, a);
  for (int d = tree.nv() - 1; d >= 0; --d) {
    const int node = tree.dof_node(d);
    const Beyond all = beyond(tree, k, node);
    const bool shifts = k.axis(d).w.isZero(0);
    if (!(1 / a.dof(d).inverse_D > rounding * (shifts ? all.mass : all.second))) return d;
  }
  return -1;
}

}  // namespace

Beyond beyond(const Tree& tree, const Kinematics& k, int node) {
  Beyond sum;
  for (int i = node; i < tree.node_count(); ++i) {
    int up = i;
    while (up > node) up = tree.node(up).parent;
    if (up != node) continue;
    const double mass = tree.node(i).mass;
    const NodeMotion& part = k.node(i);
    sum.mass += mass;
    sum.second += mass * (part.center - k.node(node).r).squaredNorm() +
                  0.5 * (part.moments.xx + part.moments.yy + part.moments.zz);
  }
  return sum;
}

int undetermined_dof(const Tree& tree) {
  Kinematics k(tree);
  Articulation a(tree);
  Random random(1);
  std::vector<double> q(static_cast<std::size_t>(tree.nq()));
  std::vector<double> z(static_cast<std::size_t>(tree.nv())), u(z.size(), 0.0);
  int lost = -1;
  for (int i = 0; i < configurations; ++i) {
    neutral_position(tree, q);
    for (double& x : z) x = random.real(-1, 1);
    displace(tree, q, z, q);
    place(tree, q, u, BaseMotion(), k);
    lost = lost_dof(tree, k, a);
    if (lost < 0) break;
  }
  return lost;
}

}  // namespace tw::multibody
