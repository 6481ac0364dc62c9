// Factorisation of matrices of 6 x 6 blocks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/body-matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

namespace tw {
namespace {

constexpr int B = BodyMatrix::block;
using Pairs = std::vector<std::pair<int, int>>;

// With numbers of its own.
struct Matrix : BodyMatrix {
  using BodyMatrix::BodyMatrix;
  void clear() { BodyMatrix::clear(numbers); }
  Numbers numbers;
};

// Fills matrix and its dense twin with numbers in [-1, 1], `diagonal` added to the diagonal.
Eigen::MatrixXd fill(Matrix& matrix, int bodies, const Pairs& pairs, double diagonal,
                     unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::MatrixXd twin = Eigen::MatrixXd::Zero(B * bodies, B * bodies);
  matrix.clear();
  const auto add = [&](int row, int column) {
    double* block = matrix.at(matrix.offset(row, column));
    for (int c = 0; c < B; ++c)
      for (int r = 0; r < B; ++r) {
        const double value = number(engine) + (row == column && r == c ? diagonal : 0);
        block[B * c + r] += value;
        twin(B * row + r, B * column + c) += value;
      }
  };
  for (int i = 0; i < bodies; ++i) add(i, i);
  for (const auto& [i, j] : pairs) {
    add(i, j);
    add(j, i);
  }
  return twin;
}

Pairs random_pairs(int bodies, int count, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_int_distribution<int> body(0, bodies - 1);
  Pairs pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const int i = body(engine), j = body(engine);
    if (i != j) pairs.emplace_back(i, j);
  }
  return pairs;
}

double solution_error(Matrix& matrix, const Eigen::MatrixXd& twin) {
  const Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(twin.rows(), -1, 2);
  Eigen::VectorXd x = twin * expected;
  if (!matrix.solve(x.data())) return std::numeric_limits<double>::infinity();
  return (x - expected).cwiseAbs().maxCoeff();
}

TEST(BodyMatrix, solves_random_graphs_of_bodies_to_1e_12) {
  for (const int bodies : {1, 2, 3, 9, 40}) {
    const Pairs pairs = bodies > 1 ? random_pairs(bodies, 2 * bodies, 5) : Pairs();
    Matrix matrix(bodies, pairs);
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Eigen::MatrixXd twin = fill(matrix, bodies, pairs, 20, seed);
      ASSERT_TRUE(matrix.factor());
      EXPECT_LT(solution_error(matrix, twin), 1e-12);
      EXPECT_LT(solution_error(matrix, twin), 1e-12);
    }
    EXPECT_EQ(matrix.factorizations(), 5u);
    EXPECT_EQ(matrix.pivoted(), 0u);
  }
}

// Speeds and angular momenta: in SI units the latter's numbers are tiny for a small body, and what
// they do to forces is huge.  Powers of two change no digit of an elimination, only the pivots that
// it finds large.
TEST(BodyMatrix, units_of_angular_momentum_do_not_matter) {
  for (const double unit : {0x1p-100, 0x1p-40, 0x1p40}) {
    Matrix matrix(1, {});
    Eigen::MatrixXd twin = fill(matrix, 1, {}, 20, 7);
    twin.rightCols(3) /= unit;
    twin.bottomRows(3) *= unit;
    // two rows of forces depend on the momenta alike, by a third as much
    twin.block<1, 3>(1, 3) = 0.3 * twin.block<1, 3>(0, 3);
    Eigen::Map<Eigen::MatrixXd>(matrix.at(matrix.offset(0, 0)), B, B) = twin;
    ASSERT_TRUE(matrix.factor());
    Eigen::VectorXd expected = Eigen::VectorXd::LinSpaced(B, -1, 2);
    expected.tail(3) *= unit;
    Eigen::VectorXd x = twin * expected;
    ASSERT_TRUE(matrix.solve(x.data()));
    x.tail(3) /= unit;
    expected.tail(3) /= unit;
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-13) << unit;
  }
}

TEST(BodyMatrix, one_body_is_pivoted_within_its_block) {
  Matrix matrix(1, {});
  const Eigen::MatrixXd twin = fill(matrix, 1, {}, 0, 3);
  // a zero diagonal all over
  Eigen::MatrixXd hollow = twin;
  double* block = matrix.at(matrix.offset(0, 0));
  for (int i = 0; i < B; ++i) hollow(i, i) = block[B * i + i] = 0;
  ASSERT_TRUE(matrix.factor());
  EXPECT_LT(solution_error(matrix, hollow), 1e-12);
}

TEST(BodyMatrix, pivoting_among_all_rows_takes_over_where_diagonal_blocks_are_singular) {
  const Pairs pairs = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Matrix matrix(4, pairs);
  for (const double tiny : {0.0, 1e-15}) {
    // diagonal blocks vanish or nearly so, the rest decides
    Eigen::MatrixXd twin = fill(matrix, 4, {{0, 1}, {2, 3}}, 0, 9);
    for (int i = 0; i < 4; ++i) {
      double* block = matrix.at(matrix.offset(i, i));
      for (int e = 0; e < B * B; ++e) block[e] *= tiny;
      twin.block<B, B>(B * i, B * i) *= tiny;
    }
    ASSERT_TRUE(matrix.factor());
    EXPECT_LT(solution_error(matrix, twin), 1e-11);
    EXPECT_LT(solution_error(matrix, twin), 1e-11);
  }
  EXPECT_EQ(matrix.pivoted(), 2u);
  // and steps back when it is not needed any more
  const Eigen::MatrixXd plain = fill(matrix, 4, pairs, 20, 1);
  ASSERT_TRUE(matrix.factor());
  EXPECT_LT(solution_error(matrix, plain), 1e-12);
  EXPECT_EQ(matrix.pivoted(), 2u);
}

TEST(BodyMatrix, singular_matrices_are_told_and_numbers_that_are_none_come_through) {
  for (const int bodies : {1, 3}) {
    Matrix matrix(bodies, {});
    matrix.clear();
    EXPECT_FALSE(matrix.factor());
    fill(matrix, bodies, {}, 20, 1);
    *matrix.at(matrix.offset(0, 0)) = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> x(static_cast<std::size_t>(B * bodies), 1.0);
    const bool solved = matrix.factor() && matrix.solve(x.data());
    EXPECT_TRUE(!solved || !std::isfinite(x[0]));
  }
}

TEST(BodyMatrix, order_of_pairs_does_not_matter) {
  Pairs pairs = random_pairs(12, 30, 4), reversed(pairs.rbegin(), pairs.rend());
  Matrix a(12, pairs), b(12, reversed);
  // one value per block, whatever the order
  const auto set = [&](Matrix& m) {
    m.clear();
    for (const auto& [i, j] : pairs)
      for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)})
        for (int e = 0; e < B * B; ++e)
          m.at(m.offset(row, column))[e] = 0.01 * (row + 2 * column + e);
    for (int i = 0; i < 12; ++i)
      for (int r = 0; r < B; ++r) m.at(m.offset(i, i))[B * r + r] = 30 + i;
  };
  set(a);
  set(b);
  ASSERT_TRUE(a.factor() && b.factor());
  std::vector<double> x(12 * B, 1.0), y = x;
  ASSERT_TRUE(a.solve(x.data()) && b.solve(y.data()));
  EXPECT_EQ(x, y);
}

}  // namespace
}  // namespace tw
