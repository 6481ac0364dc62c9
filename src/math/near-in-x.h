// Points near others along x: where many lie in a row or a plane, those near one of them are few.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tw {

class NearInX {
 public:
  // Of so few points, for which sorting is no gain, all are near.
  static constexpr std::size_t few = 32;

  // `x_of(i)`: of the points 0 to count - 1, m.
  template <class XOf>
  void set(std::size_t count, const XOf& x_of) {
    count_ = static_cast<std::uint32_t>(count);
    if (count <= few) return;
    by_x_.clear();
    for (std::uint32_t i = 0; i < count_; ++i) by_x_.push_back({x_of(i), i});
    std::sort(by_x_.begin(), by_x_.end());
  }
  // Calls visit(i) for those whose x is within reach of this, and perhaps for others; in ascending
  // order.
  template <class Visit>
  void visit(double x, double reach, const Visit& visit) {
    if (count_ <= few) {
      for (std::uint32_t i = 0; i < count_; ++i) visit(i);
      return;
    }
    reach += 1e-9 * (reach + std::abs(x));  // rounding
    near_.clear();
    auto at = std::lower_bound(by_x_.begin(), by_x_.end(), std::pair(x - reach, 0u));
    for (; at != by_x_.end() && at->first <= x + reach; ++at) near_.push_back(at->second);
    std::sort(near_.begin(), near_.end());
    for (const std::uint32_t i : near_) visit(i);
  }

 private:
  std::uint32_t count_ = 0;
  std::vector<std::pair<double, std::uint32_t>> by_x_;
  std::vector<std::uint32_t> near_;
};

}  // namespace tw
