// The matrix of a group that holds multibodies: unknowns of bodies and joints together, set column
// by column, factored and solved again and again with the same pattern.
//
// Dense LU with partial pivoting for few unknowns, KLU for many (T. A. Davis, E. Palamadai
// Natarajan, ACM TOMS 37 (2010)).  Both pivot, and must not do so by kg, m and rad: unknowns are
// taken in units in which each moves with about the same energy, and then rows are scaled to their
// largest entry.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace tw {

class CoupledMatrix {
 public:
  // Whether a matrix of this size is dense, and its pattern need not be known.
  static bool is_dense(int size);
  explicit CoupledMatrix(int size);
  // `rows_of`: of each column, the rows that may not be 0, ascending.
  explicit CoupledMatrix(std::vector<std::vector<int>> rows_of);
  ~CoupledMatrix();
  CoupledMatrix(const CoupledMatrix&) = delete;
  CoupledMatrix& operator=(const CoupledMatrix&) = delete;

  int size() const;
  const std::vector<int>& rows_of(int column) const;
  // From a column of `size` numbers; those outside the pattern are not looked at.  `unit` > 0: of
  // its unknown.
  void set_column(int column, const double* numbers, double unit);
  // False: singular, or not finite.
  bool factor();
  bool solve(double* right_side) const;
  std::uint64_t factorizations() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace tw
