// A multibody as a part of a contact group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/tree-in-group.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "integrate/arc/joint-record.h"
#include "integrate/implicit/group-rows.h"

namespace tw {

using namespace multibody;
using rows::vec;

TreeInGroup::TreeInGroup(const GroupTree& start, double end)
    : start_(&start),
      n_(start.multibody->tree.nv()),
      q0_(start.state->q),
      q_(q0_),
      tau_(index(n_)),
      u0_(index(n_)),
      rate_(index(n_)),
      base_(*start.multibody, end),
      placed_(start.multibody->tree),
      linear_(start.multibody->tree),
      articulation_(start.multibody->tree),
      linearisation_(start.multibody->tree),
      mass_(index(n_ * n_)),
      Kq_(index(n_ * n_)),
      Ku_(index(n_ * n_)),
      matrix_(index(n_ * n_)) {
  around_.gravity = start.gravity;
  around_.base = start.multibody->base;
}

std::vector<double> TreeInGroup::displaced(const double* z) const {
  std::vector<double> q(q0_.size());
  displace(tree(), q0_, {z, index(n_)}, q);
  return q;
}

void TreeInGroup::place(double time, const double* z, const double* u, BodyKinematics* bodies) {
  if (base_.moves()) base_.set(time, around_);
  displace(tree(), q0_, {z, index(n_)}, q_);
  multibody::place(tree(), q_, {u, index(n_)}, around_, placed_);
  for (int link = 0; link < tree().link_count(); ++link) {
    const PoseTwist point = link_point(*start_->multibody, placed_, link);
    BodyKinematics& body = bodies[start_->members[index(link)]];
    vec(body.x) = point.x;
    vec(body.v) = point.v;
    vec(body.w) = point.w;
    rows::store_rotation(point.q.toRotationMatrix(), body.R);
  }
}

void TreeInGroup::evaluate(const double* z, const double* u, const BodyWrench* wrenches,
                           double* z_rate, double* u_rate) {
  const std::size_t n = index(n_);
  for (int link = 0; link < tree().link_count(); ++link) {
    const BodyWrench& wrench = wrenches[start_->members[index(link)]];
    add_force(tree(), placed_, link, link_center_of_mass(tree(), placed_, link),
              vec(wrench.f) + start_->forces[index(link)]);
    add_torque(tree(), placed_, link, vec(wrench.t));
  }
  chart_rate(tree(), {z, n}, {u, n}, {z_rate, n});
  joint_torques(tree(), q_, {u, n}, start_->state->inputs(), tau_);
  if (!forward_dynamics(tree(), placed_, tau_, articulation_, {u_rate, n}))
    std::fill_n(u_rate, n, std::numeric_limits<double>::quiet_NaN());
}

void TreeInGroup::linearise(const double* u, const double* u_rate, const BodyWrench* wrenches) {
  const std::size_t n = index(n_);
  linear_ = placed_;
  std::copy_n(u, n, u0_.begin());
  std::copy_n(u_rate, n, rate_.begin());
  // the force that stays while the centre c moves on by dc turns with dc x f about the origin
  linearisation_.clear_wrenches();
  for (int link = 0; link < tree().link_count(); ++link) {
    const Vec3 force = vec(wrenches[start_->members[index(link)]].f) + start_->forces[index(link)];
    if (force.isZero()) continue;
    const Mat3 across = cross_matrix(force);
    multibody::ForceDerivative moving;
    moving.by_displacement.topLeftCorner<3, 3>() =
        across * cross_matrix(link_center_of_mass(tree(), linear_, link) - linear_.origin);
    moving.by_displacement.topRightCorner<3, 3>() = -across;
    linearisation_.add_wrench(tree(), link, moving);
  }
  multibody::linearise(tree(), linear_, rate_, linearisation_, mass_, Kq_, Ku_);
  add_joint_derivatives(tree(), q0_, u0_, start_->state->inputs(), Kq_, Ku_);
}

void TreeInGroup::set_stage_rate(double sigma) {
  sigma_ = sigma;
  const std::size_t n = index(n_);
  // columns of E are those of the unit matrix, eliminated
  std::vector<double> column(n);
  for (std::size_t k = 0; k < n; ++k) {
    std::fill(column.begin(), column.end(), 0.0);
    column[k] = 1;
    eliminate(column.data());
    double* to = matrix_.data() + n * k;
    for (std::size_t i = 0; i < n; ++i) to[i] = sigma * mass_[n * k + i] - Ku_[n * k + i];
    for (std::size_t j = 0; j < n; ++j)
      if (column[j] != 0)
        for (std::size_t i = 0; i < n; ++i) to[i] -= Kq_[n * j + i] * column[j];
  }
  fold_matrix(tree(), matrix_);
}

void TreeInGroup::eliminate(double* r) const {
  solve_chart_rate(tree(), u0_, sigma_, {r, index(n_)});
}

void TreeInGroup::right_side(const double* ru, const double* kq, double* to) const {
  const std::size_t n = index(n_);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += mass_[n * k + i] * ru[k] + Kq_[n * k + i] * kq[k];
    to[i] = sum;
  }
}

// Motions of the nodes by kq and by ku, and how their velocities change: each joint turns what
// moves beyond it, d V_i = sum over the way of S_k kq_k x (V_i - V of the node before k's).
void TreeInGroup::spread(const double* kq, const double* ku, BodyChange* changes) const {
  thread_local std::vector<Motion> moved, faster;
  const Tree& t = tree();
  moved.assign(index(t.node_count()), {});
  faster.assign(index(t.node_count()), {});
  for (int i = first_node; i < t.node_count(); ++i) {
    const Node& node = t.node(i);
    const std::size_t at = index(i), from = index(node.parent);
    Motion step, speed;
    for (int k = node.u; k < node.u + node.dofs; ++k) {
      step.add(linear_.axis(k), kq[k]);
      speed.add(linear_.axis(k), ku[k]);
    }
    moved[at] = moved[from] + step;
    // the change of the velocity against the parent's motion, carried along
    const Motion own = linear_.node(i).V - linear_.node(node.parent).V;
    Motion turned = cross(moved[at], own);
    if (node.kind == NodeKind::floating) {
      // its velocities are the world's: only where they are taken moves
      Vec3 way = Vec3::Zero();
      for (int k = 0; k < 3; ++k) way[k] = kq[node.u + k];
      turned = {Vec3::Zero(), way.cross(linear_.node(i).V.w)};
    }
    faster[at] = faster[from] + speed + turned;
  }
  for (int link = 0; link < t.link_count(); ++link) {
    const std::size_t node = index(t.link(link).node);
    const Vec3 arm = link_center_of_mass(t, linear_, link) - linear_.origin;
    BodyChange& change = changes[start_->members[index(link)]];
    const Vec3 dx = moved[node].v + moved[node].w.cross(arm);
    vec(change.x) = dx;
    vec(change.th) = moved[node].w;
    vec(change.v) =
        faster[node].v + faster[node].w.cross(arm) + linear_.node(t.link(link).node).V.w.cross(dx);
    vec(change.w) = faster[node].w;
  }
}

void TreeInGroup::gather(const BodyWrench* wrenches, double* row) const {
  thread_local std::vector<Force> force;
  const Tree& t = tree();
  force.assign(index(t.node_count()), {});
  for (int link = 0; link < t.link_count(); ++link) {
    const BodyWrench& wrench = wrenches[start_->members[index(link)]];
    const Vec3 arm = link_center_of_mass(t, linear_, link) - linear_.origin;
    force[index(t.link(link).node)] += {vec(wrench.t) + arm.cross(vec(wrench.f)), vec(wrench.f)};
  }
  for (int i = t.node_count() - 1; i >= first_node; --i) {
    const Node& node = t.node(i);
    for (int k = node.u; k < node.u + node.dofs; ++k)
      row[k] += dot(linear_.axis(k), force[index(i)]);
    force[index(node.parent)] += force[index(i)];
  }
}

bool TreeInGroup::add_unforeseen(double h, const double* u0, const double* z, const double* u1,
                                 BodyChange* changes) {
  const std::size_t n = index(n_);
  thread_local std::vector<double> row, still;
  row.resize(n);
  still.assign(n, 0);
  displace(tree(), q0_, {z, n}, q_);
  if (!unforeseen_torques(tree(), {q0_, {u0, n}}, {q_, {u1, n}}, {z, n}, start_->state->inputs(),
                          row))
    return false;
  accelerate(row.data());
  for (double& du : row) du *= h;
  spread(still.data(), row.data(), changes);
  return true;
}

double TreeInGroup::friction_doubt(const double* u0, const double* error) const {
  return multibody::friction_doubt(tree(), {u0, index(n_)}, {error, index(n_)});
}

void TreeInGroup::accelerate(double* row) const {
  Eigen::Map<Eigen::VectorXd> x(row, n_);
  if (tree().couplings().empty()) {
    const Eigen::Map<const Eigen::MatrixXd> mass(mass_.data(), n_, n_);
    x = mass.llt().solve(x).eval();
    return;
  }
  std::vector<double> folded = mass_;
  fold_matrix(tree(), folded);
  fold(row);
  x = Eigen::Map<const Eigen::MatrixXd>(folded.data(), n_, n_).llt().solve(x).eval();
  follow(row);
}

void TreeInGroup::follow(double* row) const { multibody::follow(tree(), {row, index(n_)}); }
void TreeInGroup::fold(double* row) const { multibody::fold(tree(), {row, index(n_)}); }

}  // namespace tw
