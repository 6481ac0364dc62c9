// The polynomial through a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/dense-step.h"

#include <algorithm>

namespace tw {
namespace {

constexpr int most = most_dense_degree;

// C(d,j) r^j (1-r)^(d-j), j = 0 .. d
struct Basis {
  double weight[most + 1];
  Basis(int degree, double r) {
    const double s = 1 - r;
    weight[0] = 1;
    for (int d = 1; d <= degree; ++d) {
      weight[d] = r * weight[d - 1];
      for (int j = d - 1; j > 0; --j) weight[j] = s * weight[j] + r * weight[j - 1];
      weight[0] *= s;
    }
  }
};

}  // namespace

DenseStep::DenseStep(double start, double end, int size, std::vector<double> y0_and_chart,
                     const double* rows, int count)
    : start_(start),
      end_(end),
      size_(size),
      degree_(count),
      numbers_(std::move(y0_and_chart)),
      offsets_(static_cast<std::size_t>(size * count)) {
  // from the innermost bracket outwards: times r or 1 - r, plus the next number
  for (int i = 0; i < size; ++i) {
    double q[most + 1];
    q[0] = rows[(count - 1) * size + i];
    for (int k = count - 2, d = 1; k >= -1; --k, ++d) {
      const bool times_r = k < 0 || k % 2 != 0;
      q[d] = 0;
      for (int j = d; j >= 0; --j) {
        const double share = static_cast<double>(times_r ? j : d - j) / d;
        const double before = times_r ? (j > 0 ? q[j - 1] : 0) : (j < d ? q[j] : 0);
        q[j] = share * before + (k >= 0 ? rows[k * size + i] : 0);
      }
    }
    for (int j = 1; j <= count; ++j) offsets_[static_cast<std::size_t>((j - 1) * size + i)] = q[j];
  }
}

double DenseStep::fraction(double time) const {
  return std::clamp((time - start_) / (end_ - start_), 0.0, 1.0);
}

std::vector<double> DenseStep::powers() const {
  const std::size_t size = static_cast<std::size_t>(size_);
  std::vector<double> c(size * static_cast<std::size_t>(degree_ + 1), 0.0);
  std::copy_n(numbers_.begin(), size, c.begin());
  // r^j (1-r)^(d-j) = sum_i C(d-j, i) (-1)^i r^(j+i)
  const auto choose = [](int n, int k) {
    double product = 1;
    for (int i = 1; i <= k; ++i) product = product * (n - k + i) / i;
    return product;
  };
  for (int j = 1; j <= degree_; ++j)
    for (int i = 0; i <= degree_ - j; ++i) {
      const double weight = choose(degree_, j) * choose(degree_ - j, i) * (i % 2 == 0 ? 1.0 : -1.0);
      double* to = c.data() + size * static_cast<std::size_t>(j + i);
      for (std::size_t e = 0; e < size; ++e) to[e] += weight * offsets(j)[e];
    }
  return c;
}

double DenseStep::value(int i, double time) const {
  const Basis basis(degree_, fraction(time));
  double sum = 0;
  for (int j = 1; j <= degree_; ++j) sum += basis.weight[j] * offsets(j)[i];
  return numbers_[static_cast<std::size_t>(i)] + sum;
}

Vec3 DenseStep::vector(int first, double time) const {
  const Basis basis(degree_, fraction(time));
  Vec3 sum = Vec3::Zero();
  for (int j = 1; j <= degree_; ++j)
    sum += basis.weight[j] * Eigen::Map<const Vec3>(offsets(j) + first);
  return Eigen::Map<const Vec3>(numbers_.data() + first) + sum;
}

// d sum (o_{j+1} - o_j) B_j of degree d - 1, o_0 = 0
double DenseStep::rate(int i, double time) const {
  const Basis basis(degree_ - 1, fraction(time));
  double sum = basis.weight[0] * offsets(1)[i];
  for (int j = 1; j < degree_; ++j) sum += basis.weight[j] * (offsets(j + 1)[i] - offsets(j)[i]);
  return degree_ / (end_ - start_) * sum;
}

Vec3 DenseStep::vector_rate(int first, double time) const {
  const Basis basis(degree_ - 1, fraction(time));
  using Map = Eigen::Map<const Vec3>;
  Vec3 sum = basis.weight[0] * Map(offsets(1) + first);
  for (int j = 1; j < degree_; ++j)
    sum += basis.weight[j] * (Map(offsets(j + 1) + first) - Map(offsets(j) + first));
  return degree_ / (end_ - start_) * sum;
}

void DenseStep::control(int order, int first, double from, double to, Control& points) const {
  points[0] = Vec3::Zero();
  for (int j = 1; j <= degree_; ++j) points[j] = Eigen::Map<const Vec3>(offsets(j) + first);
  // derivatives of the whole step first: differences of a small part of it would be rounding
  int degree = degree_;
  for (; degree > degree_ - order; --degree)
    for (int j = 0; j < degree; ++j)
      points[j] = degree / (end_ - start_) * (points[j + 1] - points[j]);
  // the part up to r1, then that of it from r0 on
  const double r0 = fraction(from), r1 = fraction(to);
  if (r1 < 1)
    for (int round = 1; round <= degree; ++round)
      for (int j = degree; j >= round; --j) points[j] = (1 - r1) * points[j - 1] + r1 * points[j];
  if (r0 > 0) {
    const double r = r0 / r1;
    for (int round = 1; round <= degree; ++round)
      for (int j = 0; j <= degree - round; ++j) points[j] = (1 - r) * points[j] + r * points[j + 1];
  }
  if (order > 0) return;
  for (int j = 0; j <= degree; ++j) points[j] += Eigen::Map<const Vec3>(numbers_.data() + first);
}

}  // namespace tw
