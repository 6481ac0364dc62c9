// The derivative of a multibody's equation of motion.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/derivatives.h"

#include <algorithm>

#include "base/error.h"

namespace tw::multibody {
namespace {

Force product(const Mat6& m, const Motion& a) {
  const Vec6 x = m * a.vector();
  return {x.head<3>(), x.tail<3>()};
}
// m^T a, of a motion that is paired with a force.
Force transposed_product(const Mat6& m, const Motion& a) {
  const Vec6 x = m.transpose() * a.vector();
  return {x.head<3>(), x.tail<3>()};
}

// [V x] as a matrix
Mat6 cross_matrix6(const Motion& V) {
  Mat6 m = Mat6::Zero();
  m.topLeftCorner<3, 3>() = m.bottomRightCorner<3, 3>() = cross_matrix(V.w);
  m.bottomLeftCorner<3, 3>() = cross_matrix(V.v);
  return m;
}

void set_dof_terms(const Tree& tree, const Kinematics& k, const Motion& parent_A, int i,
                   Linearisation& work) {
  const Node& node = tree.node(i);
  const Motion &V = k.node(i).V, &A = work.node(i).A;
  for (int c = 0; c < node.dofs; ++c) {
    const Motion& S = k.axis(node.u + c);
    Linearisation::DofTerms& terms = work.dof(node.u + c);
    if (node.kind != NodeKind::floating) {
      const Motion& V_p = k.node(node.parent).V;
      terms.P = cross(V_p, S);
      terms.Q = cross(parent_A, S) + cross(V_p, terms.P);
      terms.X = terms.P + cross(V, S);
    } else if (c < 3) {
      terms = {};
    } else {
      // v of the link's origin: that of the point at the origin, less what turning adds
      const Vec3 v = V.v + V.w.cross(k.node(i).r);
      terms.P = cross(V, S);
      terms.Q = cross(A, S) + cross(V, terms.P);
      terms.X = terms.P + Motion{Vec3::Zero(), v.cross(S.w)};
    }
  }
}

// Velocities and accelerations outward, each node's own terms.
void sweep_outward(const Tree& tree, const Kinematics& k, In rate, Linearisation& work) {
  work.node(world_node).A = k.node(world_node).A;
  work.node(base_node).A = k.node(base_node).A;
  for (int i = first_node; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const NodeMotion& motion = k.node(i);
    Linearisation::NodeTerms& terms = work.node(i);
    const Motion parent_A = work.node(node.parent).A;
    // what u' add to the accelerations at u' = 0, which `motion` has
    Motion A = motion.A + (parent_A - k.node(node.parent).A);
    for (int d = node.u; d < node.u + node.dofs; ++d)
      A.add(k.axis(d), rate[static_cast<std::size_t>(d)]);
    terms.A = A;
    terms.I = motion.inertia(node.mass);
    terms.B = CoriolisMatrix::of(terms.I, motion.V);
    terms.W = motion.W;
    terms.F = net_force(node.mass, motion, A) + motion.W;
    terms.wrench_beyond = terms.wrench;
    if (terms.wrench) {
      const ForceDerivative& given = work.wrenches[static_cast<std::size_t>(i)];
      terms.Y = given.by_velocity;
      terms.L = given.by_displacement - given.by_velocity * cross_matrix6(motion.V);
    } else {
      terms.L.setZero(), terms.Y.setZero();
    }
    set_dof_terms(tree, k, parent_A, i, work);
  }
}

void add_to_parent(const Linearisation::NodeTerms& child, Linearisation::NodeTerms& parent) {
  parent.I += child.I;
  parent.B += child.B;
  parent.F += child.F;
  parent.W += child.W;
  if (!child.wrench_beyond) return;
  parent.L += child.L;
  parent.Y += child.Y;
  parent.wrench_beyond = true;
}

// Whether a node's axes turn along when its dof c moves, so that within the joint no force turns
// against them.
bool axes_turn_along(const Node& node, int c) { return node.kind != NodeKind::floating || c < 3; }

}  // namespace

Linearisation::Linearisation(const Tree& tree)
    : nodes(static_cast<std::size_t>(tree.node_count())),
      dofs(static_cast<std::size_t>(tree.nv())),
      wrenches(nodes.size()) {}

void Linearisation::clear_wrenches() {
  for (NodeTerms& terms : nodes) terms.wrench = false;
}

void Linearisation::add_wrench(const Tree& tree, int link, const ForceDerivative& derivative) {
  const int at = tree.link(link).node;
  ForceDerivative& sum = wrenches[static_cast<std::size_t>(at)];
  if (!node(at).wrench) sum = ForceDerivative();
  node(at).wrench = true;
  sum.by_displacement += derivative.by_displacement;
  sum.by_velocity += derivative.by_velocity;
}

void linearise(const Tree& tree, const Kinematics& k, In rate, Linearisation& work, Out M, Out Kq,
               Out Ku) {
  const auto n = static_cast<std::size_t>(tree.nv());
  std::fill(M.begin(), M.end(), 0.0);
  std::fill(Kq.begin(), Kq.end(), 0.0);
  std::fill(Ku.begin(), Ku.end(), 0.0);
  sweep_outward(tree, k, rate, work);
  for (int i = tree.node_count() - 1; i >= first_node; --i) {
    const Node& node = tree.node(i);
    const Linearisation::NodeTerms& at = work.node(i);
    for (int d = node.u + node.dofs - 1; d >= node.u; --d) {
      const Motion& S = k.axis(d);
      const Linearisation::DofTerms& D = work.dof(d);
      // column d: what forces change by its motion; row d: S^T of the matrices
      Force inner = -(at.B * D.P + at.I * D.Q), column_u = -(at.B * S + at.I * D.X);
      const Force row_I = at.I * S, row_B = at.B.transposed(S);
      Force row_L, row_Y;
      const bool wrench = at.wrench_beyond;
      if (wrench) {
        inner += product(at.L, S) + product(at.Y, D.P);
        column_u += product(at.Y, S);
        row_L = transposed_product(at.L, S);
        row_Y = transposed_product(at.Y, S);
      }
      const Force turned = cross(S, at.F), row_W = cross(S, at.W);
      const Force outer = inner - turned;
      const std::size_t row = static_cast<std::size_t>(d);
      // within the joint, both triangles
      const bool along = axes_turn_along(node, d - node.u);
      for (int e = node.u; e < node.u + node.dofs; ++e) {
        const Motion& T = k.axis(e);
        const std::size_t to = static_cast<std::size_t>(e) + n * row;
        Kq[to] = dot(T, along ? inner : outer);
        // axes that go along change the work of W: (S x T).W = -T.(S x* W)
        if (along) Kq[to] -= dot(T, row_W);
        Ku[to] = dot(T, column_u);
        M[to] = dot(T, row_I);
      }
      for (int e = tree.dof_parent(node.u); e >= 0; e = tree.dof_parent(e)) {
        const Motion& T = k.axis(e);
        const Linearisation::DofTerms& E = work.dof(e);
        const std::size_t column = static_cast<std::size_t>(e);
        const std::size_t up = column + n * row, down = row + n * column;
        M[up] = M[down] = dot(T, row_I);
        Kq[up] = dot(T, outer);
        Ku[up] = dot(T, column_u);
        double by_q = -dot(E.P, row_B) - dot(E.Q, row_I) + dot(T, row_W);
        double by_u = -dot(T, row_B) - dot(E.X, row_I);
        if (wrench) {
          by_q += dot(T, row_L) + dot(E.P, row_Y);
          by_u += dot(T, row_Y);
        }
        Kq[down] = by_q;
        Ku[down] = by_u;
      }
    }
    if (node.parent >= first_node) add_to_parent(at, work.node(node.parent));
  }
}

void add_cross_derivative(const Side& a, const Side& b, const ForceDerivative& derivative,
                          std::size_t stride, double* Kq, double* Ku) {
  TW_ASSERT(a.k.origin == b.k.origin, "coupled multibodies are placed about different origins");
  const int node_a = a.tree.link(a.link).node, node_b = b.tree.link(b.link).node;
  const Mat6 L =
      derivative.by_displacement - derivative.by_velocity * cross_matrix6(b.k.node(node_b).V);
  for (int e = b.tree.last_dof(node_b); e >= 0; e = b.tree.dof_parent(e)) {
    const Motion& S = b.k.axis(e);
    const Force by_q = product(L, S) + product(derivative.by_velocity, b.work.dof(e).P);
    const Force by_u = product(derivative.by_velocity, S);
    const std::size_t column = stride * static_cast<std::size_t>(e);
    for (int d = a.tree.last_dof(node_a); d >= 0; d = a.tree.dof_parent(d)) {
      Kq[column + static_cast<std::size_t>(d)] += dot(a.k.axis(d), by_q);
      Ku[column + static_cast<std::size_t>(d)] += dot(a.k.axis(d), by_u);
    }
  }
}

}  // namespace tw::multibody
