// Block LU and KLU of matrices of 6 x 6 blocks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/body-matrix.h"

#include <klu.h>

#include <algorithm>
#include <cmath>

namespace tw {

namespace {

constexpr int per_body = BodyMatrix::block;

// block LU is trusted up to this backward error; 1e-15 is usual
constexpr double trusted_error = 1e-11;

}  // namespace

// scalars by columns
struct BodyMatrix::Pivoted {
  std::vector<std::pair<int, int>> entries;  // blocks (column, row), ascending
  std::vector<int> Ap, Ai;
  std::vector<double> Ax;
  klu_common common;
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

  Pivoted(int bodies, const std::vector<std::pair<int, int>>& pairs);
  ~Pivoted() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
};

BodyMatrix::Pivoted::Pivoted(int bodies, const std::vector<std::pair<int, int>>& pairs) {
  for (int i = 0; i < bodies; ++i) entries.emplace_back(i, i);
  for (const auto& [i, j] : pairs) {
    entries.emplace_back(i, j);
    entries.emplace_back(j, i);
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  Ap.push_back(0);
  for (auto first = entries.begin(); first != entries.end();) {
    auto last = first;
    while (last != entries.end() && last->first == first->first) ++last;
    for (int c = 0; c < per_body; ++c) {
      for (auto e = first; e != last; ++e)
        for (int r = 0; r < per_body; ++r) Ai.push_back(per_body * e->second + r);
      Ap.push_back(static_cast<int>(Ai.size()));
    }
    first = last;
  }
  Ax.resize(Ai.size());
  klu_defaults(&common);
  symbolic = klu_analyze(per_body * bodies, Ap.data(), Ai.data(), &common);
}

BodyMatrix::BodyMatrix(int bodies, const std::vector<std::pair<int, int>>& pairs)
    : bodies_(bodies), pairs_(pairs), blocks_(bodies, pairs) {}

BodyMatrix::~BodyMatrix() = default;

void BodyMatrix::clear(Numbers& numbers) {
  numbers_ = &numbers;
  numbers.values.assign(blocks_.size(), 0.0);
}

bool BodyMatrix::factor() {
  ++factorizations_;
  numbers_->factors = numbers_->values;
  // the pivoting within one block is all that one body needs
  unchecked_ = bodies_ > 1;
  by_pivoted_ = !blocks_.factor(numbers_->factors.data());
  return !by_pivoted_ || (bodies_ > 1 && factor_pivoted());
}

bool BodyMatrix::factor_pivoted() {
  ++pivoted_;
  unchecked_ = false;
  by_pivoted_ = true;
  if (!pivoted_factors_) pivoted_factors_ = std::make_unique<Pivoted>(bodies_, pairs_);
  Pivoted& p = *pivoted_factors_;
  if (!p.symbolic) return false;
  double* to = p.Ax.data();
  for (std::size_t first = 0; first < p.entries.size();) {
    std::size_t last = first;
    while (last < p.entries.size() && p.entries[last].first == p.entries[first].first) ++last;
    for (int c = 0; c < per_body; ++c)
      for (std::size_t e = first; e < last; ++e)
        to = std::copy_n(at(offset(p.entries[e].second, p.entries[e].first)) + per_body * c,
                         per_body, to);
    first = last;
  }
  klu_free_numeric(&p.numeric, &p.common);
  p.numeric = klu_factor(p.Ap.data(), p.Ai.data(), p.Ax.data(), p.symbolic, &p.common);
  return p.numeric && p.common.status == KLU_OK;
}

bool BodyMatrix::solve(double* right_side) {
  if (!by_pivoted_ && !unchecked_) {
    blocks_.solve(numbers_->factors.data(), right_side);
    return true;
  }
  if (!by_pivoted_) {
    thread_local std::vector<double> given;
    given.assign(right_side, right_side + per_body * bodies_);
    blocks_.solve(numbers_->factors.data(), right_side);
    unchecked_ = false;
    if (blocks_.backward_error(numbers_->values.data(), right_side, given.data()) < trusted_error)
      return true;
    std::copy(given.begin(), given.end(), right_side);
    if (!factor_pivoted()) return false;
  }
  Pivoted& p = *pivoted_factors_;
  return klu_solve(p.symbolic, p.numeric, per_body * bodies_, 1, right_side, &p.common) != 0;
}

}  // namespace tw
