// A square matrix of 6 x 6 blocks, one row and column of blocks a body, factored and solved again
// and again with the same pattern.
//
// By block LU (block-lu.h), whose first solution after each factorisation is checked; where it lost
// digits, KLU with pivoting among all rows takes over (T. A. Davis, E. Palamadai Natarajan, ACM
// TOMS 37 (2010)).  What is solved is a function of the matrix and the right sides since it was
// factored.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "integrate/implicit/block-lu.h"

namespace tw {

class BodyMatrix {
 public:
  static constexpr int block = BlockLu::block;
  static constexpr int dense_bodies = 1;

  // `pairs`: bodies (i, j), i != j, with blocks (i, j) and (j, i); repetitions are allowed.
  BodyMatrix(int bodies, const std::vector<std::pair<int, int>>& pairs);
  ~BodyMatrix();
  BodyMatrix(const BodyMatrix&) = delete;
  BodyMatrix& operator=(const BodyMatrix&) = delete;

  // What it is made of while it is factored and solved: for all matrices of a thread in turn, or
  // each of many large ones would have its own.
  struct Numbers {
    std::vector<double> values, factors;
  };

  // All zeros, in `numbers` from now on; first of all, too.
  void clear(Numbers& numbers);
  // A block of the pattern, by columns; to be added to.
  std::size_t offset(int row, int column) const { return blocks_.offset(row, column); }
  double* at(std::size_t offset) { return numbers_->values.data() + offset; }
  // False: singular, or not finite.
  bool factor();
  // False: singular after all (then the right side is spoilt).
  bool solve(double* right_side);
  std::uint64_t factorizations() const { return factorizations_; }
  // Of those, by KLU.
  std::uint64_t pivoted() const { return pivoted_; }

 private:
  struct Pivoted;
  bool factor_pivoted();

  int bodies_;
  std::vector<std::pair<int, int>> pairs_;
  Numbers* numbers_ = nullptr;
  BlockLu blocks_;
  bool unchecked_ = false;  // no solution since the factorisation
  std::unique_ptr<Pivoted> pivoted_factors_;
  bool by_pivoted_ = false;
  std::uint64_t factorizations_ = 0, pivoted_ = 0;
};

}  // namespace tw
