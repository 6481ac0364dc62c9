// Dense LU and KLU of bodies and joints together.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/coupled-matrix.h"

#include <Eigen/KLUSupport>
#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "base/index.h"

namespace tw {

struct CoupledMatrix::Data {
  int size = 0;
  std::vector<std::vector<int>> rows_of;  // dense: one row for all columns
  Eigen::MatrixXd dense;
  Eigen::PartialPivLU<Eigen::MatrixXd> dense_factors;
  Eigen::SparseMatrix<double> sparse;
  Eigen::KLU<Eigen::SparseMatrix<double>> sparse_factors;
  bool full = true, analysed = false;
  Eigen::VectorXd units, scale;  // of columns and rows
  std::uint64_t factorizations = 0;
};

bool CoupledMatrix::is_dense(int size) { return size <= cost::most_dense_unknowns; }

CoupledMatrix::CoupledMatrix(int size) : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  d.size = size;
  d.rows_of.emplace_back(index(size));
  std::iota(d.rows_of.front().begin(), d.rows_of.front().end(), 0);
  d.units.setOnes(size);
  d.scale.resize(size);
  d.dense.setZero(size, size);
}

CoupledMatrix::CoupledMatrix(std::vector<std::vector<int>> rows_of)
    : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  d.rows_of = std::move(rows_of);
  const int n = d.size = static_cast<int>(d.rows_of.size());
  d.full = false;
  d.units.setOnes(n);
  d.scale.resize(n);
  std::vector<Eigen::Triplet<double>> pattern;
  for (int column = 0; column < n; ++column)
    for (const int row : d.rows_of[index(column)]) pattern.emplace_back(row, column, 0.0);
  d.sparse.resize(n, n);
  d.sparse.setFromTriplets(pattern.begin(), pattern.end());
}
CoupledMatrix::~CoupledMatrix() = default;

int CoupledMatrix::size() const { return data_->size; }
const std::vector<int>& CoupledMatrix::rows_of(int column) const {
  return data_->rows_of[data_->full ? 0 : index(column)];
}
std::uint64_t CoupledMatrix::factorizations() const { return data_->factorizations; }

void CoupledMatrix::set_column(int column, const double* numbers, double unit) {
  Data& d = *data_;
  d.units[column] = unit;
  if (d.full) {
    for (int row = 0; row < d.size; ++row) d.dense(row, column) = unit * numbers[row];
    return;
  }
  double* to = d.sparse.valuePtr() + d.sparse.outerIndexPtr()[column];
  for (const int row : d.rows_of[index(column)]) *to++ = unit * numbers[row];
}

bool CoupledMatrix::factor() {
  Data& d = *data_;
  ++d.factorizations;
  const int n = size();
  d.scale.setZero();
  if (d.full)
    d.scale = d.dense.cwiseAbs().rowwise().maxCoeff();
  else
    for (int column = 0; column < n; ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(d.sparse, column); it; ++it)
        d.scale[it.row()] = std::max(d.scale[it.row()], std::abs(it.value()));
  if (!d.scale.allFinite() || !(d.scale.minCoeff() > 0)) return false;
  d.scale = d.scale.cwiseInverse();
  if (d.full) {
    d.dense_factors.compute(d.scale.asDiagonal() * d.dense);
    return d.dense_factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 0;
  }
  Eigen::SparseMatrix<double> scaled = d.sparse;
  for (int column = 0; column < n; ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator it(scaled, column); it; ++it)
      it.valueRef() *= d.scale[it.row()];
  if (!d.analysed) d.sparse_factors.analyzePattern(scaled);
  d.analysed = true;
  d.sparse_factors.factorize(scaled);
  return d.sparse_factors.info() == Eigen::Success;
}

bool CoupledMatrix::solve(double* right_side) const {
  const Data& d = *data_;
  Eigen::Map<Eigen::VectorXd> x(right_side, size());
  const Eigen::VectorXd scaled = d.scale.cwiseProduct(x);
  if (d.full)
    x = d.dense_factors.solve(scaled);
  else
    x = d.sparse_factors.solve(scaled);
  x = x.cwiseProduct(d.units);
  return x.allFinite();
}

}  // namespace tw
