// Inverse kinematics by Levenberg-Marquardt with active limits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/inverse-kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "math/rotation-vector.h"
#include "multibody/couplings.h"
#include "multibody/jacobian.h"
#include "multibody/limits.h"

namespace tw::multibody {
namespace {

constexpr double turn_weight = 1.0 / 6;      // of the reach
constexpr double standard_tolerance = 1e-9;  // of the reach
constexpr double limit_slack = 1e-14;        // rad or m: rounding
constexpr double longest_step = 1;           // rad, or reaches
constexpr int most_iterations = 100, stall_after = 8;
constexpr double stall_gain = 0.3;
// lambda over the trace of J J^T: at the start, its bounds, and how it changes
constexpr double first_damping = 1, least_damping = 1e-12, most_damping = 1e6;
// errors below this share of the reach damp less: near the end it converges quadratically
constexpr double near_error = 0.3;
constexpr double better = 0.5, worse = 4;

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// Length of what lies between the base and the point, m; sliders count by how far they are.
double reach_of(const Tree& tree, const Target& target, In q) {
  double sum = target.point.norm();
  for (int i = target.link; i >= 0; i = tree.link(i).parent) {
    const Link& link = tree.link(i);
    if (link.joint == JointKind::free) break;
    sum += link.placement.p.norm();
    if (link.joint == JointKind::prismatic) sum += std::abs(q[static_cast<std::size_t>(link.q)]);
  }
  return sum > 0 ? sum : 1;
}

class Search {
 public:
  Search(const Tree& tree, const BaseMotion& around, const Target& target, In start,
         double tolerance)
      : tree_(tree),
        around_(around),
        target_(target),
        reach_(reach_of(tree, target, start)),
        tolerance_(tolerance > 0 ? tolerance : standard_tolerance * reach_),
        k_(tree),
        u_(static_cast<std::size_t>(tree.nv())),
        z_(u_),
        limits_(u_.size()),
        at_limit_(u_.size()),
        J_(6, tree.nv()),
        free_J_(6, tree.nv()) {
    for (const Axis& axis : tree.axes())
      if (axis.ball)
        balls_.push_back(&axis);
      else
        limits_[static_cast<std::size_t>(axis.u)] = &axis;
  }

  // From q; leaves the best there and in `best`.  True: reached.
  bool run(std::vector<double>& q);
  // A start of its own within the limits, free links as in `given`.
  void draw(Random& random, In given, std::vector<double>& q) const;
  void cut(std::vector<double>& q) const;

  double residual() const { return residual_; }
  int iterations() const { return iterations_; }

 private:
  Vec6 error(const std::vector<double>& q);
  void set_jacobian();
  void hold(const Vec6& e, const std::vector<double>& q);
  void try_step(const Vec6& e, double damping, const std::vector<double>& q,
                std::vector<double>& trial);

  const Tree& tree_;
  const BaseMotion& around_;
  const Target& target_;
  double reach_, tolerance_;
  Kinematics k_;
  std::vector<double> u_, z_;
  std::vector<const Axis*> limits_;  // by dof, of scalar ones
  std::vector<const Axis*> balls_;
  std::vector<bool> at_limit_;
  Matrix6X J_, free_J_;
  double residual_ = 0;
  int iterations_ = 0;
};

Vec6 Search::error(const std::vector<double>& q) {
  place(tree_, q, u_, around_, k_);
  const Frame X = link_frame(tree_, k_, target_.link);
  Vec6 e = Vec6::Zero();
  e.head<3>() = target_.position - X * target_.point;
  if (target_.attitude)
    e.tail<3>() = turn_weight * reach_ * turn_between(Quat(X.R), *target_.attitude);
  return e;
}

// Of the place that `error` looked at last.
void Search::set_jacobian() {
  link_jacobian(tree_, k_, target_.link, Out(J_.data(), static_cast<std::size_t>(J_.size())));
  const Vec3 arm = link_frame(tree_, k_, target_.link).R * target_.point;
  for (int d = 0; d < tree_.nv(); ++d) {
    auto column = J_.col(d);
    if (tree_.node(tree_.dof_node(d)).kind == NodeKind::floating) {
      column.setZero();
      continue;
    }
    const Vec3 w = column.tail<3>();
    column.head<3>() += w.cross(arm);
    column.tail<3>() *= target_.attitude ? turn_weight * reach_ : 0;
  }
  for (const Coupling& c : tree_.couplings()) {
    J_.col(c.leader) += c.ratio * J_.col(c.follower);
    J_.col(c.follower).setZero();
  }
}

// Takes out what is at a limit and pushed against it.
void Search::hold(const Vec6& e, const std::vector<double>& q) {
  for (int d = 0; d < tree_.nv(); ++d) {
    const Axis* axis = limits_[static_cast<std::size_t>(d)];
    if (!axis) continue;
    const double at = q[static_cast<std::size_t>(axis->q)], push = J_.col(d).dot(e);
    if ((at <= axis->law.lower && push < 0) || (at >= axis->law.upper && push > 0))
      J_.col(d).setZero();
  }
  // of a spherical joint the direction out alone
  for (const Axis* axis : balls_) {
    const LimitedAngle now =
        limited_angle(*axis, quaternion_at(&q[static_cast<std::size_t>(axis->q)]));
    auto columns = J_.middleCols<3>(axis->u);
    const Vec6 out = columns * now.direction;
    if (now.angle >= axis->law.upper - limit_slack && out.dot(e) > 0)
      columns -= out * now.direction.transpose();
  }
}

void Search::cut(std::vector<double>& q) const {
  for (const Axis* axis : limits_)
    if (axis) {
      double& at = q[static_cast<std::size_t>(axis->q)];
      at = std::clamp(at, axis->law.lower, axis->law.upper);
    }
  for (const Axis* axis : balls_) {
    double* at = &q[static_cast<std::size_t>(axis->q)];
    set_quaternion(at, within_limit(*axis, quaternion_at(at)));
  }
  follow_positions(tree_, q);
}

// z is the damped step of the joints that are free, given how far those at their limits go; who
// passes a limit goes just there, and the others are asked again.
void Search::try_step(const Vec6& e, double damping, const std::vector<double>& q,
                      std::vector<double>& trial) {
  free_J_ = J_;
  Vec6 rest = e;
  const double added = damping * J_.squaredNorm() / 6;
  std::fill(at_limit_.begin(), at_limit_.end(), false);
  for (bool again = true; again;) {
    Mat6 A = free_J_ * free_J_.transpose();
    A.diagonal().array() += added;
    const Vec6 y = A.ldlt().solve(rest);
    again = false;
    for (int d = 0; d < tree_.nv(); ++d) {
      const auto i = static_cast<std::size_t>(d);
      if (at_limit_[i]) continue;
      z_[i] = free_J_.col(d).dot(y);
      if (!limits_[i]) continue;
      const double at = q[static_cast<std::size_t>(limits_[i]->q)];
      const double to = std::clamp(at + z_[i], limits_[i]->law.lower, limits_[i]->law.upper) - at;
      if (to == z_[i] || std::abs(at + z_[i] - (at + to)) < limit_slack) continue;
      z_[i] = to;
      rest -= J_.col(d) * to;
      free_J_.col(d).setZero();
      at_limit_[i] = again = true;
    }
  }
  double longest = 0;
  for (int d = 0; d < tree_.nv(); ++d) {
    const bool slides = tree_.node(tree_.dof_node(d)).kind == NodeKind::slider;
    longest = std::max(longest, std::abs(z_[static_cast<std::size_t>(d)]) / (slides ? reach_ : 1));
  }
  if (longest > longest_step)
    for (double& x : z_) x *= longest_step / longest;
  follow(tree_, z_);
  displace(tree_, q, z_, trial);
  cut(trial);
}

bool Search::run(std::vector<double>& q) {
  std::vector<double> trial(q.size());
  Vec6 e = error(q);
  double squared = e.squaredNorm(), damping = first_damping;
  const double near = near_error * near_error * reach_ * reach_;
  double past[stall_after];
  std::fill(past, past + stall_after, std::numeric_limits<double>::infinity());
  set_jacobian();
  hold(e, q);
  for (int i = 0; i < most_iterations && squared > tolerance_ * tolerance_; ++i) {
    double& before = past[i % stall_after];
    // nothing free moves it: no step is left
    if (squared > (1 - stall_gain) * before || J_.isZero(0)) break;
    before = squared;
    ++iterations_;
    try_step(e, damping * std::min(1.0, squared / near), q, trial);
    const Vec6 next = error(trial);
    if (!(next.squaredNorm() < squared)) {
      damping *= worse;
      if (damping > most_damping) break;
      continue;
    }
    damping = std::max(damping * better, least_damping);
    q.swap(trial);
    e = next;
    squared = e.squaredNorm();
    set_jacobian();
    hold(e, q);
  }
  residual_ = std::sqrt(squared);
  return residual_ <= tolerance_;
}

void Search::draw(Random& random, In given, std::vector<double>& q) const {
  std::vector<double> z(u_.size(), 0.0);
  q.assign(given.begin(), given.end());
  for (const Axis& axis : tree_.axes()) {
    const auto u = static_cast<std::size_t>(axis.u), at = static_cast<std::size_t>(axis.q);
    if (axis.ball) {
      for (std::size_t c = 0; c < 3; ++c) z[u + c] = random.real(-2, 2);
      continue;
    }
    const bool slides = tree_.node(tree_.dof_node(axis.u)).kind == NodeKind::slider;
    const double most = slides ? reach_ : pi;
    const double lower = std::max(axis.law.lower, std::min(-most, axis.law.upper - 2 * most));
    const double upper = std::min(axis.law.upper, std::max(most, axis.law.lower + 2 * most));
    z[u] = random.real(lower, upper) - q[at];
  }
  displace(tree_, q, z, q);
  cut(q);
}

}  // namespace

Reached inverse_kinematics(const Tree& tree, const BaseMotion& around, const Target& target,
                           In start, const SearchOptions& options) {
  TW_REQUIRE(target.link >= 0 && target.link < tree.link_count(),
             "link is " + std::to_string(target.link) + "; expected a number from 0 to " +
                 std::to_string(tree.link_count() - 1));
  TW_REQUIRE(is_finite(target.position) && is_finite(target.point) &&
                 (!target.attitude || is_finite(*target.attitude)),
             "a number of the target of " + tree.link(target.link).name +
                 " is not finite; expected a place in the world");
  TW_REQUIRE(!options.tolerance || (std::isfinite(*options.tolerance) && *options.tolerance > 0),
             "tolerance is " + show(*options.tolerance) + "; expected a positive number of metres");
  TW_REQUIRE(options.starts > 0, "starts is " + std::to_string(options.starts) +
                                     "; expected a positive number of starts");
  TW_REQUIRE(start.size() == static_cast<std::size_t>(tree.nq()),
             std::to_string(start.size()) + " numbers to start from; expected " +
                 std::to_string(tree.nq()));
  for (double x : start)
    TW_REQUIRE(std::isfinite(x), "start is " + show(x) + "; expected finite numbers");
  Target unit = target;
  if (unit.attitude) unit.attitude->normalize();
  Search search(tree, around, unit, start, options.tolerance.value_or(0));
  Random random(1);
  Reached result;
  std::vector<double> q(start.begin(), start.end());
  normalize(tree, q);
  search.cut(q);
  for (int i = 0; i < options.starts && !result.q; ++i) {
    if (i > 0) search.draw(random, start, q);
    const bool reached = search.run(q);
    if (i == 0 || search.residual() < result.residual) result.residual = search.residual();
    if (reached) result.q = q;
  }
  result.iterations = search.iterations();
  return result;
}

}  // namespace tw::multibody
