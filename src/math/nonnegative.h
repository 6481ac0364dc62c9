// Quadratic programmes with unknowns that may not be negative.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

namespace tw {

// The x >= 0 with A x + q >= 0 and x.(A x + q) = 0, which is the least of x.A x/2 + q.x: A
// symmetric and positive semidefinite, n by n, its diagonal 1 or thereabouts; A x + q >= 0 is met
// to within `tolerance` > 0.  Nothing where no such x was found in 10 n + 10 exchanges.  Unknowns
// become free one at a time, the one that gains most first.
// Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23, with
// A = E^T E, q = -E^T f.
std::optional<Eigen::VectorXd> solve_nonnegative(const Eigen::MatrixXd& A, const Eigen::VectorXd& q,
                                                 double tolerance);

}  // namespace tw
