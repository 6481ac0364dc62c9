// LU of sparse matrices of 6 x 6 blocks with a symmetric pattern, pivoting within diagonal blocks.
//
// Pivots are eliminated in order of least degree in the graph of blocks (ties: the lower index).
// For pivot k with later neighbours S_k:
//   L_ik = A_ik A_kk^-1,  A_ij -= L_ik A_kj  for all i, j in S_k.
// There is no pivoting between blocks: callers check the residual.
//
// Cost: sum |S_k|^2 products of blocks of 22 ns; 0.1 ms for a cubic lattice of 64 bodies, 1.5 ms
// for one of 216.
// Source: I. S. Duff, A. M. Erisman, J. K. Reid, Direct Methods for Sparse Matrices, ch. 7 and 10.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace tw {

class BlockLu {
 public:
  static constexpr int block = 6, block_size = block * block;

  BlockLu() = default;
  // `pairs`: (i, j), i != j, with blocks (i, j) and (j, i); repetitions are allowed.
  BlockLu(int rows, const std::vector<std::pair<int, int>>& pairs);

  // Blocks by columns: where block (row, column) begins, for pairs of the pattern.
  std::size_t offset(int row, int column) const;
  // Numbers in all blocks, fill included.
  std::size_t size() const { return static_cast<std::size_t>(block_size) * blocks_; }

  // In place.  False: a diagonal block is singular or not finite.
  bool factor(double* values) const;
  void solve(const double* factors, double* x) const;
  // Largest |A x - b|_i over the largest (|A| |x| + |b|)_i, the first and the second three rows of
  // the blocks apart (forces and torques); `values` before factoring.  Infinite where a number is
  // not finite.
  double backward_error(const double* values, const double* x, const double* b) const;

 private:
  void order(const std::vector<std::pair<int, int>>& pairs);
  void set_targets();
  const double* at(const double* values, std::size_t index) const {
    return values + block_size * index;
  }
  double* at(double* values, std::size_t index) const { return values + block_size * index; }
  std::size_t index(int row_position, int column_position) const;

  int rows_ = 0;
  std::size_t blocks_ = 0;
  std::vector<int> pivots_, positions_;  // body of a position and the reverse
  std::vector<std::size_t> starts_;      // of S_k in later_
  std::vector<int> later_;               // positions, ascending
  std::vector<std::size_t> target_starts_;
  std::vector<unsigned> targets_;  // edge of (i, j), i < j in S_k
};

}  // namespace tw
