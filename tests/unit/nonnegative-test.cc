// Against all subsets of unknowns, and where the matrix is singular.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/nonnegative.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace tw {
namespace {

constexpr double tolerance = 1e-10;

double value(const Eigen::MatrixXd& A, const Eigen::VectorXd& q, const Eigen::VectorXd& x) {
  return 0.5 * x.dot(A * x) + q.dot(x);
}

// The least value over all subsets of free unknowns whose solution is not negative.
double least_of_all(const Eigen::MatrixXd& A, const Eigen::VectorXd& q) {
  const auto n = static_cast<int>(q.size());
  double least = 0;
  for (unsigned subset = 1; subset < 1u << n; ++subset) {
    std::vector<Eigen::Index> free;
    for (int i = 0; i < n; ++i)
      if (subset >> i & 1) free.push_back(i);
    const Eigen::VectorXd some = A(free, free).colPivHouseholderQr().solve(-q(free));
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    x(free) = some;
    if (some.minCoeff() >= 0) least = std::min(least, value(A, q, x));
  }
  return least;
}

void expect_solves(const Eigen::MatrixXd& A, const Eigen::VectorXd& q) {
  const auto x = solve_nonnegative(A, q, tolerance);
  ASSERT_TRUE(x);
  EXPECT_GE(x->minCoeff(), 0);
  const Eigen::VectorXd slope = A * *x + q;
  EXPECT_GE(slope.minCoeff(), -tolerance);
  EXPECT_LE(x->cwiseProduct(slope).cwiseAbs().maxCoeff(), 1e-8 * (1 + x->maxCoeff()));
}

struct RandomProblem {
  std::mt19937 bits{7};
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(bits); });
  }
};

TEST(Nonnegative, is_the_best_of_all_subsets) {
  RandomProblem random;
  for (int n = 1; n <= 9; ++n)
    for (int trial = 0; trial < 40; ++trial) {
      const Eigen::MatrixXd E = random.matrix(n + 2, n).colwise().normalized();
      const Eigen::MatrixXd A = E.transpose() * E;
      const Eigen::VectorXd q = random.matrix(n, 1);
      expect_solves(A, q);
      EXPECT_NEAR(value(A, q, *solve_nonnegative(A, q, tolerance)), least_of_all(A, q), 1e-8);
    }
}

// More unknowns than rank, as where a box stands on four corners: any of the solutions.
TEST(Nonnegative, may_be_singular) {
  RandomProblem random;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd E = random.matrix(4, 12).colwise().normalized();
    expect_solves(E.transpose() * E, E.transpose() * random.matrix(4, 1));
  }
}

TEST(Nonnegative, is_zero_where_nothing_is_gained) {
  const auto x =
      solve_nonnegative(Eigen::MatrixXd::Identity(3, 3), Eigen::Vector3d(1, 0, 2), 1e-12);
  ASSERT_TRUE(x);
  EXPECT_EQ(x->cwiseAbs().maxCoeff(), 0);
}

}  // namespace
}  // namespace tw
