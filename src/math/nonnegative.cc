// Quadratic programmes with unknowns that may not be negative.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/nonnegative.h"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace tw {
namespace {

using Index = Eigen::Index;

// Where the free unknowns want to be, all others being 0.
Eigen::VectorXd without_bounds(const Eigen::MatrixXd& A, const Eigen::VectorXd& q,
                               const std::vector<Index>& free) {
  return A(free, free).colPivHouseholderQr().solve(-q(free));
}

// How much of the way to a goal that is not positive an unknown may go.
double share_of_way(double now, double goal) { return now > 0 ? now / (now - goal) : 0; }

// Moves x towards the goal until the first free unknown is 0, which is not free any more.
void go_to_bound(Eigen::VectorXd& x, const Eigen::VectorXd& goal, std::vector<Index>& free) {
  double share = 1;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double then = goal[static_cast<Index>(i)];
    if (then <= 0) share = std::min(share, share_of_way(x[free[i]], then));
  }
  std::vector<Index> left;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double now = x[free[i]], then = goal[static_cast<Index>(i)];
    const bool stops = then <= 0 && share_of_way(now, then) <= share;
    x[free[i]] = stops ? 0 : now + share * (then - now);
    if (!stops) left.push_back(free[i]);
  }
  free = std::move(left);
}

}  // namespace

std::optional<Eigen::VectorXd> solve_nonnegative(const Eigen::MatrixXd& A, const Eigen::VectorXd& q,
                                                 double tolerance) {
  const Index n = q.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<Index> free;
  for (Index exchanges = 0; exchanges < 10 * n + 10; ++exchanges) {
    const Eigen::VectorXd slope = A * x + q;
    Index next = -1;
    double least = -tolerance;
    for (Index i = 0; i < n; ++i)
      if (slope[i] < least && std::find(free.begin(), free.end(), i) == free.end())
        least = slope[next = i];
    if (next < 0) return x;
    free.push_back(next);
    for (;;) {
      const Eigen::VectorXd goal = without_bounds(A, q, free);
      if (!goal.allFinite()) return std::nullopt;
      if (goal.minCoeff() > 0) {
        x(free) = goal;
        break;
      }
      go_to_bound(x, goal, free);
      if (free.empty()) break;
    }
  }
  return std::nullopt;
}

}  // namespace tw
