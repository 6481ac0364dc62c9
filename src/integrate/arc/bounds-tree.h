// Bounds of a row of motions that follow one another, and of any run of them: blocks of sixteen are
// added up when they are complete, blocks of sixteen blocks likewise, and so on.  Adding up bounds
// takes the larger and the smaller of numbers, so a run has the same bits in whatever blocks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "integrate/trajectory.h"

namespace tw {

class BoundsTree {
 public:
  static constexpr std::size_t block = 16;

  std::size_t size() const { return levels_.empty() ? 0 : levels_.front().size(); }
  const MotionBounds& operator[](std::size_t i) const { return levels_.front()[i]; }
  void append(MotionBounds bounds) {
    for (std::size_t level = 0;; ++level) {
      if (levels_.size() == level) levels_.emplace_back();
      std::vector<MotionBounds>& row = levels_[level];
      row.push_back(bounds);
      if (row.size() % block != 0) return;
      bounds = {};
      for (std::size_t i = row.size() - block; i < row.size(); ++i) bounds.add(row[i]);
    }
  }
  // Adds those of the motions first to last - 1.
  void add(std::size_t first, std::size_t last, MotionBounds& sum) const {
    for (std::size_t level = 0; first < last; ++level) {
      const std::vector<MotionBounds>& row = levels_[level];
      const bool top = level + 1 == levels_.size();
      while (first < last && (top || first % block != 0)) sum.add(row[first++]);
      while (first < last && last % block != 0) sum.add(row[--last]);
      first /= block;
      last /= block;
    }
  }

 private:
  std::vector<std::vector<MotionBounds>> levels_;  // of the motions, of blocks of them, ...
};

}  // namespace tw
