// Ordering, factorisation and solution of sparse matrices of 6 x 6 blocks.
//
// Blocks are numbered: diagonal by position, then U_kj for j in S_k of every k, then L_jk likewise.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/block-lu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#ifdef __FMA__
#include <immintrin.h>
#endif

namespace tw {

namespace {

constexpr int B = BlockLu::block;

// a column of a block: four and two numbers
using Four = double __attribute__((vector_size(32)));
using Two = double __attribute__((vector_size(16)));

struct Column {
  Four head;
  Two tail;
};

#define TW_BLOCK inline __attribute__((always_inline))

TW_BLOCK Column load(const double* p) {
  Column c;
  std::memcpy(&c.head, p, sizeof c.head);
  std::memcpy(&c.tail, p + 4, sizeof c.tail);
  return c;
}

TW_BLOCK void store(const Column& c, double* p) {
  std::memcpy(p, &c.head, sizeof c.head);
  std::memcpy(p + 4, &c.tail, sizeof c.tail);
}

// from -= factor c; fused where the target has it: half the work, and written out, so that no
// compiler decides
TW_BLOCK void subtract(Column& from, const Column& c, double factor) {
#ifdef __FMA__
  from.head = _mm256_fnmadd_pd(_mm256_set1_pd(factor), c.head, from.head);
  from.tail = _mm_fnmadd_pd(_mm_set1_pd(factor), c.tail, from.tail);
#else
  from.head -= factor * c.head;
  from.tail -= factor * c.tail;
#endif
}

// c -= a b
TW_BLOCK void subtract_product(const double* a, const double* b, double* c) {
  Column columns[B];
#pragma GCC unroll 6
  for (int k = 0; k < B; ++k) columns[k] = load(a + B * k);
  for (int j = 0; j < B; ++j) {
    Column sum = load(c + B * j);
#pragma GCC unroll 6
    for (int k = 0; k < B; ++k) subtract(sum, columns[k], b[B * j + k]);
    store(sum, c + B * j);
  }
}

// a <- -a b, for b = -A_kk^-1: a A_kk^-1
TW_BLOCK void multiply(double* a, const double* b) {
  Column columns[B];
#pragma GCC unroll 6
  for (int k = 0; k < B; ++k) columns[k] = load(a + B * k);
  for (int j = 0; j < B; ++j) {
    Column sum = {};
#pragma GCC unroll 6
    for (int k = 0; k < B; ++k) subtract(sum, columns[k], b[B * j + k]);
    store(sum, a + B * j);
  }
}

// y -= a x
TW_BLOCK void subtract_product_vector(const double* a, const double* x, double* y) {
  Column sum = load(y);
#pragma GCC unroll 6
  for (int k = 0; k < B; ++k) subtract(sum, load(a + B * k), x[k]);
  store(sum, y);
}

// y += |a| |x|
TW_BLOCK void add_magnitudes(const double* a, const double* x, double* y) {
  Column sum = load(y);
#pragma GCC unroll 6
  for (int k = 0; k < B; ++k) {
    const Column c = load(a + B * k);
    const Column size = {c.head < 0 ? -c.head : c.head, c.tail < 0 ? -c.tail : c.tail};
    subtract(sum, size, -std::abs(x[k]));
  }
  store(sum, y);
}

// The unit of the second half of a block's columns in terms of the first.  The halves have units of
// their own (speeds and forces, angular momenta and torques): a pivot is large or small only in
// units in which the four quarters, the largest of each, are balanced.  With VV, VL, LV, LL: rows
// and columns times 1/sqrt(VV) and 1/sqrt(LL) make the diagonal ones 1, and u then makes VL as
// large as LV.
double unit_of_half(const double* a) {
  double most[2][2] = {};
  for (int j = 0; j < B; ++j)
    for (int i = 0; i < B; ++i) {
      double& quarter = most[2 * i / B][2 * j / B];
      quarter = std::max(quarter, std::abs(a[B * j + i]));
    }
  const double squared = (most[0][0] / most[1][1]) * (most[1][0] / most[0][1]);
  // nothing couples the halves, or only one way: then any unit will do, or none
  return squared >= 0 && std::isfinite(squared) ? std::sqrt(squared) : 1;
}

// a <- -a^-1 by Gauss-Jordan with partial pivoting: rows of the transpose
bool invert_negative(double* a) {
  int swapped[B];
  const double unit = unit_of_half(a);
  double units[B] = {1, 1, 1, unit, unit, unit};
  for (int k = 0; k < B; ++k) {
    int p = k;
    for (int i = k + 1; i < B; ++i)
      if (units[i] * std::abs(a[B * i + k]) > units[p] * std::abs(a[B * p + k])) p = i;
    std::swap(units[k], units[p]);
    const double pivot = a[B * p + k];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    swapped[k] = p;
    if (p != k) std::swap_ranges(a + B * k, a + B * k + B, a + B * p);

    // row k over the pivot, the others without column k
    a[B * k + k] = 1;
    const double inverse = 1 / pivot;
    Column row = load(a + B * k);
    row.head *= inverse;
    row.tail *= inverse;
    store(row, a + B * k);
    for (int i = 0; i < B; ++i) {
      if (i == k) continue;
      const double factor = a[B * i + k];
      a[B * i + k] = 0;
      Column other = load(a + B * i);
      subtract(other, row, factor);
      store(other, a + B * i);
    }
  }
  // the other order back
  for (int k = B - 1; k >= 0; --k)
    if (swapped[k] != k)
      for (int i = 0; i < B; ++i) std::swap(a[B * i + k], a[B * i + swapped[k]]);
  for (int i = 0; i < BlockLu::block_size; ++i) a[i] = -a[i];
  return true;
}

// a set of small numbers
using Word = std::uint64_t;
constexpr int word_bits = 64;

template <class Visit>
void visit_set(const Word* set, int words, Visit visit) {
  for (int w = 0; w < words; ++w)
    for (Word rest = set[w]; rest != 0; rest &= rest - 1)
      visit(word_bits * w + std::countr_zero(rest));
}

std::size_t u(int i) { return static_cast<std::size_t>(i); }

// Degrees of rows, and the least of every so many.
class Degrees {
 public:
  explicit Degrees(std::vector<int> of) : of_(std::move(of)) {
    for (std::size_t first = 0; first < of_.size(); first += together)
      least_.push_back(least_from(first));
  }
  int operator[](int row) const { return of_[u(row)]; }
  void set(int row, int degree) {
    const int old = std::exchange(of_[u(row)], degree);
    int& least = least_[u(row) / together];
    if (degree <= least)
      least = degree;
    else if (old == least)
      least = least_from(u(row) / together * together);
  }
  // The first row of the least degree.
  int first_least() const {
    const auto block = std::min_element(least_.begin(), least_.end());
    const auto from = of_.begin() + (block - least_.begin()) * std::ptrdiff_t{together};
    return static_cast<int>(std::find(from, of_.end(), *block) - of_.begin());
  }

 private:
  static constexpr std::size_t together = 64;
  int least_from(std::size_t first) const {
    const auto from = of_.begin() + static_cast<std::ptrdiff_t>(first);
    return *std::min_element(
        from, from + static_cast<std::ptrdiff_t>(std::min(together, of_.size() - first)));
  }

  std::vector<int> of_, least_;
};

}  // namespace

BlockLu::BlockLu(int rows, const std::vector<std::pair<int, int>>& pairs) : rows_(rows) {
  order(pairs);
  blocks_ = u(rows) + 2 * later_.size();
  set_targets();
}

// least degree first; eliminating a row links its neighbours with each other
void BlockLu::order(const std::vector<std::pair<int, int>>& pairs) {
  const int words = (rows_ + word_bits - 1) / word_bits;
  std::vector<Word> graph(u(rows_) * u(words));
  const auto set_of = [&](int i) { return graph.data() + u(words) * u(i); };
  const auto bit = [](int i) { return Word{1} << (i % word_bits); };
  const auto count = [&](int i) {
    int total = 0;
    for (int w = 0; w < words; ++w) total += std::popcount(set_of(i)[w]);
    return total;
  };
  for (const auto& [i, j] : pairs) {
    set_of(i)[j / word_bits] |= bit(j);
    set_of(j)[i / word_bits] |= bit(i);
  }
  std::vector<int> counts(u(rows_));
  for (int i = 0; i < rows_; ++i) counts[u(i)] = count(i);
  Degrees degree(std::move(counts));
  std::vector<int> filled;  // the words of the pivot's set that are not empty

  // bodies in the place of positions at first
  positions_.resize(u(rows_));
  pivots_.reserve(u(rows_));
  starts_.reserve(u(rows_) + 1);
  later_.reserve(2 * pairs.size());
  starts_.push_back(0);
  for (int position = 0; position < rows_; ++position) {
    const int pivot = degree.first_least();
    degree.set(pivot, rows_);
    pivots_.push_back(pivot);
    positions_[u(pivot)] = position;
    const Word* theirs = set_of(pivot);
    filled.clear();
    for (int w = 0; w < words; ++w)
      if (theirs[w] != 0) filled.push_back(w);
    visit_set(theirs, words, [&](int i) {
      later_.push_back(i);
      Word* own = set_of(i);
      int more = -2;  // the pivot goes; the row itself, which is among theirs
      for (const int w : filled) {
        more += std::popcount(theirs[w] & ~own[w]);
        own[w] |= theirs[w];
      }
      own[i / word_bits] &= ~bit(i);
      own[pivot / word_bits] &= ~bit(pivot);
      degree.set(i, degree[i] + more);
    });
    starts_.push_back(later_.size());
  }
  for (int& i : later_) i = positions_[u(i)];
  for (int k = 0; k < rows_; ++k)
    std::sort(later_.begin() + static_cast<std::ptrdiff_t>(starts_[u(k)]),
              later_.begin() + static_cast<std::ptrdiff_t>(starts_[u(k) + 1]));
}

std::size_t BlockLu::index(int row, int column) const {
  if (row == column) return u(row);
  const int k = std::min(row, column), other = std::max(row, column);
  const auto first = later_.begin() + static_cast<std::ptrdiff_t>(starts_[u(k)]);
  const auto last = later_.begin() + static_cast<std::ptrdiff_t>(starts_[u(k) + 1]);
  const std::size_t edge =
      u(static_cast<int>(std::lower_bound(first, last, other) - later_.begin()));
  return u(rows_) + edge + (row < column ? 0 : later_.size());
}

std::size_t BlockLu::offset(int row, int column) const {
  return u(block_size) * index(positions_[u(row)], positions_[u(column)]);
}

// the later ones of S_k are in S_i for every i of S_k: eliminating k linked them
void BlockLu::set_targets() {
  target_starts_.reserve(u(rows_));
  for (int k = 0; k < rows_; ++k) {
    target_starts_.push_back(targets_.size());
    for (std::size_t i = starts_[u(k)]; i < starts_[u(k) + 1]; ++i) {
      std::size_t edge = starts_[u(later_[i])];
      for (std::size_t j = i + 1; j < starts_[u(k) + 1]; ++j, ++edge) {
        while (later_[edge] != later_[j]) ++edge;
        targets_.push_back(static_cast<unsigned>(edge));
      }
    }
  }
}

// diagonal blocks become -A_kk^-1, lower ones L_ik = A_ik A_kk^-1, upper ones stay
bool BlockLu::factor(double* values) const {
  for (int k = 0; k < rows_; ++k) {
    double* diagonal = at(values, u(k));
    if (!invert_negative(diagonal)) return false;
    const std::size_t first = u(rows_) + starts_[u(k)], count = starts_[u(k) + 1] - starts_[u(k)];
    const double* upper = at(values, first);
    double* lower = at(values, first + later_.size());
    for (std::size_t i = 0; i < count; ++i) multiply(lower + block_size * i, diagonal);
    const unsigned* target = targets_.data() + target_starts_[u(k)];
    for (std::size_t i = 0; i < count; ++i) {
      const double *left = lower + block_size * i, *right = upper + block_size * i;
      subtract_product(left, right, at(values, u(later_[starts_[u(k)] + i])));
      for (std::size_t j = i + 1; j < count; ++j) {
        double* above = at(values, u(rows_) + *target++);
        subtract_product(left, upper + block_size * j, above);
        subtract_product(lower + block_size * j, right, above + block_size * later_.size());
      }
    }
  }
  return true;
}

void BlockLu::solve(const double* factors, double* x) const {
  const double* upper = at(factors, u(rows_));
  const double* lower = at(factors, u(rows_) + later_.size());
  const auto part = [&](int position) { return x + B * pivots_[u(position)]; };
  for (int k = 0; k < rows_; ++k)
    for (std::size_t e = starts_[u(k)]; e < starts_[u(k) + 1]; ++e)
      subtract_product_vector(lower + block_size * e, part(k), part(later_[e]));
  for (int k = rows_ - 1; k >= 0; --k) {
    double value[B] = {};
    double* rest = part(k);
    for (std::size_t e = starts_[u(k)]; e < starts_[u(k) + 1]; ++e)
      subtract_product_vector(upper + block_size * e, part(later_[e]), rest);
    subtract_product_vector(at(factors, u(k)), rest, value);
    std::copy_n(value, B, rest);
  }
}

double BlockLu::backward_error(const double* values, const double* x, const double* b) const {
  thread_local std::vector<double> rest, scale;
  rest.assign(b, b + B * rows_);
  scale.resize(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) scale[i] = std::abs(b[i]);
  const auto add = [&](std::size_t index, int row, int column) {
    const double* a = at(values, index);
    const double* from = x + B * pivots_[u(column)];
    subtract_product_vector(a, from, rest.data() + B * pivots_[u(row)]);
    add_magnitudes(a, from, scale.data() + B * pivots_[u(row)]);
  };
  for (int k = 0; k < rows_; ++k) {
    add(u(k), k, k);
    for (std::size_t e = starts_[u(k)]; e < starts_[u(k) + 1]; ++e) {
      add(u(rows_) + e, k, later_[e]);
      add(u(rows_) + e + later_.size(), later_[e], k);
    }
  }
  // halves of the blocks apart: their units differ
  double worst = 0, sum = 0;
  for (const std::size_t half : {0u, 3u}) {
    double largest = 1e-300, error = 0;
    for (std::size_t row = half; row < rest.size(); row += B)
      for (std::size_t i = row; i < row + 3; ++i) {
        largest = std::max(largest, scale[i]);
        error = std::max(error, std::abs(rest[i]));
        sum += scale[i];
      }
    worst = std::max(worst, error / largest);
  }
  return std::isfinite(sum) ? worst : std::numeric_limits<double>::infinity();
}

}  // namespace tw
