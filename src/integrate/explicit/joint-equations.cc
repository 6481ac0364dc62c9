// The equations of a multibody that touches nothing, for explicit methods.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/joint-equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/index.h"
#include "base/never.h"
#include "multibody/impulses.h"

namespace tw {

using namespace multibody;

namespace {

// Of each dof, whether it is a distance, m.
std::vector<bool> distances(const Tree& tree) {
  std::vector<bool> of(index(tree.nv()), false);
  for (const Node& node : tree.nodes())
    if (node.kind == NodeKind::slider || node.kind == NodeKind::floating)
      for (int k = 0; k < std::min(node.dofs, 3); ++k) of[index(node.u + k)] = true;
  return of;
}

// The fastest of these velocities, distances as shares of `size`, `rate` at least, 1/s.
double fastest_rate(const std::vector<bool>& is_distance, const double* u, double size,
                    double rate) {
  for (std::size_t k = 0; k < is_distance.size(); ++k)
    rate = std::max(rate, std::abs(u[k]) / (is_distance[k] ? size : 1));
  return rate;
}

}  // namespace

JointEquations::JointEquations(const GroupTree& tree, double end, double tolerance, double size,
                               double rate)
    : tree_(tree),
      n_(tree.multibody->tree.nv()),
      tolerance_(tolerance),
      size_(size),
      rate_(rate),
      is_distance_(distances(tree.multibody->tree)),
      base_(*tree.multibody, end),
      placed_(tree.multibody->tree),
      articulation_(tree.multibody->tree),
      q_(index(tree.multibody->tree.nq())),
      tau_(index(n_)) {
  around_.gravity = tree.gravity;
  around_.base = tree.multibody->base;
}

int JointEquations::chart_size() const { return tree_.multibody->tree.nq(); }

void JointEquations::slope(double time, const double* y, const double* chart, double* slope) const {
  const Tree& tree = tree_.multibody->tree;
  const std::size_t n = index(n_);
  const In z{y, n}, u{y + n, n};
  displace(tree, {chart, q_.size()}, z, q_);
  if (base_.moves()) base_.set(time, around_);
  place(tree, q_, u, around_, placed_);
  for (int link = 0; link < tree.link_count(); ++link)
    if (const Vec3& force = tree_.forces[index(link)]; !force.isZero(0))
      add_force(tree, placed_, link, link_center_of_mass(tree, placed_, link), force);
  chart_rate(tree, z, u, {slope, n});
  joint_torques(tree, q_, u, tree_.state->inputs(), tau_);
  if (!forward_dynamics(tree, placed_, tau_, articulation_, {slope + n, n}))
    std::fill_n(slope + n, n, std::numeric_limits<double>::quiet_NaN());
}

void JointEquations::tolerances(const double* y, const double*, double* allowed) const {
  const double fastest = fastest_rate(is_distance_, y + n_, size_, rate_);
  for (int k = 0; k < n_; ++k) {
    const double scale = is_distance_[index(k)] ? size_ : 1;
    allowed[k] = tolerance_ * scale;
    allowed[n_ + k] = tolerance_ * scale * fastest;
  }
}

// No joint turns by more than a chart bears; and not for ever where nothing moves, or past a part
// of how the base does.
double JointEquations::longest_step(const double* y, const double*, const double*) const {
  double fastest = rate_;
  for (int k = 0; k < n_; ++k)
    if (!is_distance_[index(k)]) fastest = std::max(fastest, std::abs(y[n_ + k]));
  const double longest = answer::most_step_turn / fastest;
  return base_.moves() ? std::min(longest, answer::motion_span) : longest;
}

void JointEquations::recentre(double* y, double* slope, double* chart) const {
  const Tree& tree = tree_.multibody->tree;
  displace(tree, {chart, q_.size()}, {y, index(n_)}, q_);
  std::copy(q_.begin(), q_.end(), chart);
  std::fill_n(y, n_, 0.0);
  // z' = u where z is 0
  std::copy_n(y + n_, n_, slope);
}

namespace {

// Of one dof: its axis, (stiffness/inertia) and damping/inertia.
struct DofRate {
  std::size_t axis;
  int dof;
  double squared_frequency, damping;
};

// Of all dofs where something acts; with infinite rates where the tree is singular.
std::vector<DofRate> dof_rates(const GroupTree& start, In q, In u) {
  const Tree& tree = start.multibody->tree;
  const MultibodyState& state = *start.state;
  std::vector<DofRate> rates;
  const std::vector<Axis>& axes = tree.axes();
  Kinematics placed(tree);
  Articulation factors(tree);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisSpec& law = axes[i].law;
    ServoGains servo;
    if (!state.servos.empty()) servo = state.servos[i];
    double stiffness = law.stiffness + servo.stiffness, damping = law.damping + servo.damping;
    if (law.friction > 0) damping += law.friction / friction_speed(axes[i]);
    if (!state.stops.empty()) stiffness += stop_rigidity(axes[i], state.stops[i], q);
    if (stiffness == 0 && damping == 0) continue;
    if (rates.empty()) {
      BaseMotion around;
      around.base = start.multibody->base;
      place(tree, q, u, around, placed);
      if (!factor(tree, placed, factors)) return {{i, axes[i].u, never, never}};
    }
    for (int k = axes[i].u; k < axes[i].u + (axes[i].ball ? 3 : 1); ++k) {
      const double yields = inverse_inertia_of_dof({tree, placed, factors}, k);
      rates.push_back({i, k, stiffness * yields, damping * yields});
    }
  }
  return rates;
}

JointRates largest(const std::vector<DofRate>& rates) {
  JointRates most;
  for (const DofRate& rate : rates) {
    most.squared_frequency = std::max(most.squared_frequency, rate.squared_frequency);
    most.damping = std::max(most.damping, rate.damping);
  }
  return most;
}

}  // namespace

JointRates joint_rates(const GroupTree& start) {
  return largest(dof_rates(start, start.state->q, start.state->u));
}

bool is_nonstiff(const GroupTree& start, double size, double rate) {
  std::vector<double> u = start.state->u;
  // how fast it flies as a whole says nothing of how fast its forces change
  for (const Node& node : start.multibody->tree.nodes())
    if (node.kind == NodeKind::floating) std::fill_n(u.begin() + node.u, 3, 0.0);
  const double most =
      answer::stiff_ratio * fastest_rate(distances(start.multibody->tree), u.data(), size, rate);
  const JointRates rates = joint_rates(start);
  return rates.damping <= most && std::sqrt(rates.squared_frequency) <= most;
}

// As of bodies on springs (bond-equations.h): RODAS4 takes steps of
//   h = (C tolerance/V)^(1/4)/omega
// through a swing of frequency omega whose velocity has the amplitude V, the explicit method steps
// of about a radian of the fastest swing there is.  V follows from u' of the joint and how it
// changes: one of the two is large at any phase.
bool swings_widely(const GroupStart& start, double time, const std::vector<double>& q,
                   const std::vector<double>& u) {
  const GroupTree& tree = start.trees.front();
  if (!tree.state->stops.empty()) return false;
  const std::vector<DofRate> rates = dof_rates(tree, q, u);
  const JointRates most = largest(rates);
  const double fastest = std::sqrt(most.squared_frequency);
  if (!(fastest > 0) || !std::isfinite(fastest)) return false;
  if (most.damping > answer::most_explicit_damping * fastest) return false;

  // slopes a part of a swing later
  const JointEquations equations(tree, start.end, start.joint_tolerance, start.joint_size,
                                 start.joint_rate);
  const double h = 1e-3 / fastest;
  std::vector<double> y(u.size(), 0.0);
  y.insert(y.end(), u.begin(), u.end());
  std::vector<double> slope(y.size()), later(y.size());
  equations.slope(time, y.data(), q.data(), slope.data());
  for (std::size_t e = 0; e < y.size(); ++e) y[e] += h * slope[e];
  equations.slope(time + h, y.data(), q.data(), later.data());
  const std::vector<bool> is_distance = distances(tree.multibody->tree);
  double shortest = never;
  for (const DofRate& rate : rates) {
    if (!(rate.squared_frequency > 0)) continue;
    const Axis& axis = tree.multibody->tree.axes()[rate.axis];
    const int member = tree.members[index(axis.link)];
    const double lever = is_distance[index(rate.dof)] ? 1 : start.members[index(member)].radius;
    const double omega = std::sqrt(rate.squared_frequency);
    const std::size_t at = u.size() + index(rate.dof);
    const double widest =
        lever * std::max(std::abs(slope[at]) / omega,
                         std::abs(later[at] - slope[at]) / (h * rate.squared_frequency));
    const double fourth = answer::first_step_error * start.velocity_tolerance / widest;
    shortest = std::min(shortest, std::sqrt(std::sqrt(fourth)) / omega);
  }
  return shortest * fastest < answer::explicit_swing;
}

}  // namespace tw
