// What impulses do to a multibody.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/impulses.h"

#include <array>

namespace tw::multibody {
namespace {

// Unit forces (and torques, after them) at r: columns F.
template <int n>
std::array<Force, n> unit_forces(const Vec3& r) {
  std::array<Force, n> F;
  for (std::size_t c = 0; c < n; ++c) {
    const Vec3 e = Vec3::Unit(static_cast<int>(c % 3));
    F[c] = c < 3 ? Force{r.cross(e), e} : Force{e, Vec3::Zero()};
  }
  return F;
}

// One dof on the way: y = S^T F; F gives up what the dof yields to.
template <int n>
Eigen::Matrix<double, n, 1> pass(const Motion& S, const Articulation::Dof& dof,
                                 std::array<Force, n>& F) {
  Eigen::Matrix<double, n, 1> y;
  for (int c = 0; c < n; ++c) {
    Force& column = F[static_cast<std::size_t>(c)];
    y[c] = dot(S, column);
    column.add(dof.U, -y[c] * dof.inverse_D);
  }
  return y;
}

template <int n>
Eigen::Matrix<double, n, n> gather(const Factored& f, int link, const Vec3& point) {
  Eigen::Matrix<double, n, n> K = Eigen::Matrix<double, n, n>::Zero();
  auto F = unit_forces<n>(point - f.k.origin);
  for (int d = f.tree.last_dof(f.tree.link(link).node); d >= 0; d = f.tree.dof_parent(d)) {
    const auto y = pass<n>(f.k.axis(d), f.a.dof(d), F);
    K += (f.a.dof(d).inverse_D * y) * y.transpose();
  }
  return K;
}

// Velocities of a point of the link, and its turns where n is 6, by the columns of W: n rows.
template <int n>
Eigen::Matrix<double, n, Eigen::Dynamic> moved_by_couplings(const Factored& f, int link,
                                                            const Vec3& point) {
  const CouplingFactors& c = f.a.couplings;
  Eigen::Matrix<double, n, Eigen::Dynamic> B(n, c.W.cols());
  for (Eigen::Index g = 0; g < B.cols(); ++g) {
    const Motion& motion =
        c.moved[static_cast<std::size_t>(g)][static_cast<std::size_t>(f.tree.link(link).node)];
    B.template block<3, 1>(0, g) = motion.v + motion.w.cross(point - f.k.origin);
    if constexpr (n == 6) B.template block<3, 1>(3, g) = motion.w;
  }
  return B;
}

template <int n>
Eigen::Matrix<double, n, n> answer_of(const Factored& f, int link, const Vec3& point) {
  Eigen::Matrix<double, n, n> K = gather<n>(f, link, point);
  if (f.tree.couplings().empty()) return K;
  const auto B = moved_by_couplings<n>(f, link, point);
  K -= B * f.a.couplings.inverse * B.transpose();
  return K;
}

}  // namespace

Mat3 inverse_inertia(const Factored& f, int link, const Vec3& point) {
  return answer_of<3>(f, link, point);
}

Mat6 spatial_inverse_inertia(const Factored& f, int link, const Vec3& point) {
  return answer_of<6>(f, link, point);
}

InverseInertias inverse_inertias(const Factored& f, int a, const Vec3& point_a, int b,
                                 const Vec3& point_b) {
  InverseInertias K{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
  auto Fa = unit_forces<3>(point_a - f.k.origin), Fb = unit_forces<3>(point_b - f.k.origin);
  int da = f.tree.last_dof(f.tree.link(a).node), db = f.tree.last_dof(f.tree.link(b).node);
  // children have greater numbers: the greater of two is on the way of one alone
  while (da >= 0 || db >= 0) {
    const int d = da > db ? da : db;
    const bool of_a = d == da, of_b = d == db;
    const Articulation::Dof& dof = f.a.dof(d);
    Vec3 ya = Vec3::Zero(), yb = Vec3::Zero();
    if (of_a) ya = pass<3>(f.k.axis(d), dof, Fa);
    if (of_b) yb = pass<3>(f.k.axis(d), dof, Fb);
    if (of_a) K.aa += (dof.inverse_D * ya) * ya.transpose();
    if (of_b) K.bb += (dof.inverse_D * yb) * yb.transpose();
    if (of_a && of_b) K.ab += (dof.inverse_D * ya) * yb.transpose();
    if (of_a) da = f.tree.dof_parent(da);
    if (of_b) db = f.tree.dof_parent(db);
  }
  if (f.tree.couplings().empty()) return K;
  const auto Ba = moved_by_couplings<3>(f, a, point_a), Bb = moved_by_couplings<3>(f, b, point_b);
  const Eigen::MatrixXd& inverse = f.a.couplings.inverse;
  K.aa -= Ba * inverse * Ba.transpose();
  K.ab -= Ba * inverse * Bb.transpose();
  K.bb -= Bb * inverse * Bb.transpose();
  return K;
}

double inverse_inertia_of_dof(const Factored& f, int dof) {
  double sum = f.a.dof(dof).inverse_D;
  Force F;
  F.add(f.a.dof(dof).U, -sum);
  for (int d = f.tree.dof_parent(dof); d >= 0; d = f.tree.dof_parent(d)) {
    const double y = dot(f.k.axis(d), F), inverse = f.a.dof(d).inverse_D;
    sum += y * y * inverse;
    F.add(f.a.dof(d).U, -y * inverse);
  }
  if (f.tree.couplings().empty()) return sum;
  const Eigen::RowVectorXd w = f.a.couplings.W.row(dof);
  return sum - (w * f.a.couplings.inverse * w.transpose()).value();
}

ImpulseWork::ImpulseWork(const Tree& tree)
    : impulse(static_cast<std::size_t>(tree.node_count())), change(impulse.size()) {}

void velocity_change(const Factored& f, std::span<const LinkImpulse> impulses, In generalised,
                     ImpulseWork& work, Out du) {
  for (Force& F : work.impulse) F = Force();
  for (const LinkImpulse& given : impulses) {
    Force& F = work.impulse[static_cast<std::size_t>(f.tree.link(given.link).node)];
    F += Force{(given.point - f.k.origin).cross(given.linear) + given.angular, given.linear};
  }
  for (int i = f.tree.node_count() - 1; i >= first_node; --i) {
    const Node& node = f.tree.node(i);
    Force& F = work.impulse[static_cast<std::size_t>(i)];
    for (int d = node.u + node.dofs - 1; d >= node.u; --d) {
      const auto at = static_cast<std::size_t>(d);
      const Articulation::Dof& dof = f.a.dof(d);
      du[at] = dot(f.k.axis(d), F) + (generalised.empty() ? 0 : generalised[at]);
      F.add(dof.U, -du[at] * dof.inverse_D);
    }
    work.impulse[static_cast<std::size_t>(node.parent)] += F;
  }
  for (int i = first_node; i < f.tree.node_count(); ++i) {
    const Node& node = f.tree.node(i);
    Motion change = work.change[static_cast<std::size_t>(node.parent)];
    for (int d = node.u; d < node.u + node.dofs; ++d) {
      const auto at = static_cast<std::size_t>(d);
      const Articulation::Dof& dof = f.a.dof(d);
      du[at] = (du[at] - dot(change, dof.U)) * dof.inverse_D;
      change.add(f.k.axis(d), du[at]);
    }
    work.change[static_cast<std::size_t>(i)] = change;
  }
  if (!f.tree.couplings().empty()) take_excess(f.tree, f.a.couplings, du, work.change);
}

}  // namespace tw::multibody
