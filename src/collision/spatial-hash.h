// A hierarchical spatial hash over axis-aligned boxes: who may overlap whom.
//
// A box lives on the level whose cells (edge 2^level) just hold it, in the one cell that holds its
// centre.  Boxes of a level with half-extents h that overlap a box B then have their centre in B
// grown by h: a query visits those cells, on each level where somebody lives.  Each level is a table
// of 2^k cells along each axis, wrapped around: cell (x, y, z) is bucket (x, y, z) mod 2^k.  A query
// needs at most 2^k cells along an axis and so meets each bucket, and each box, once at most;
// strangers from the other side of the wrap are sorted out by the box test, as neighbours are.
//
// Source: B. Mirtich, "Efficient algorithms for two-phase collision detection", MERL TR-97-23 (the
// hash of the paper's appendix A; one cell a box instead of marks in all).
// Cost: an insertion writes one cell.  A query reads about 20 cells on the box's own level, more on
// finer ones, but on none more than its table has: 2 to 16 for each box there.  Boxes are kept
// in single precision, rounded outwards, beside the links: one cache line decides about most.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "math/aabb.h"

namespace tw {

class SpatialHash {
 public:
  // Inserts or moves box `id` (dense numbers from 0).  Must be finite and not empty.
  void place(std::uint32_t id, const Aabb& box);
  void remove(std::uint32_t id);
  const Aabb& box(std::uint32_t id) const { return boxes_[id]; }

  // Calls visit(other) once for each other box that overlaps (closed boxes) that of `id`.  The visit
  // must not place or remove boxes.
  template <class Visit>
  void overlapping(std::uint32_t id, Visit&& visit) const {
    for (const Level& level : levels_)
      if (level.count > 0) overlapping_on(level, id, visit);
  }

  std::size_t size() const { return count_; }
  // Every box stands in the bucket that its centre says, once: for validators.
  bool consistent() const;

 private:
  static constexpr std::uint32_t nobody = 0xffffffffu;

  // Single precision, outwards: overlaps wherever the true boxes do.
  struct RoughBox {
    std::array<float, 3> lo{}, hi{};
    bool overlaps(const RoughBox& other) const {
      // without jumps: the outcome of each comparison is a coin's
      return (lo[0] <= other.hi[0]) & (other.lo[0] <= hi[0]) & (lo[1] <= other.hi[1]) &
             (other.lo[1] <= hi[1]) & (lo[2] <= other.hi[2]) & (other.lo[2] <= hi[2]);
    }
  };
  struct Entry {
    RoughBox rough;
    std::uint32_t next = nobody, previous = nobody;  // in the bucket's list
    std::uint32_t bucket = 0;
    std::int16_t level = 0;         // exponent of the cell edge
    bool present = false;
  };
  struct Level {
    int exponent = 0;
    double per_cell = 1;            // 1 / cell edge
    Vec3 reach = Vec3::Zero();      // the largest half-extents that ever lived here
    int bits = 2;                   // of a cell coordinate in the table
    std::vector<std::uint32_t> first = std::vector<std::uint32_t>(64, nobody);
    std::size_t count = 0;

    std::int64_t cell(double coordinate) const;
    std::size_t bucket(std::int64_t x, std::int64_t y, std::int64_t z) const {
      const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
      return static_cast<std::size_t>(
          (((static_cast<std::uint64_t>(x) & mask) << bits | (static_cast<std::uint64_t>(y) & mask))
           << bits) | (static_cast<std::uint64_t>(z) & mask));
    }
  };

  static int exponent_of(const Aabb& box);
  static RoughBox rough(const Aabb& box);
  Level& level_at(int exponent);
  void link(Level& level, std::uint32_t id);
  void unlink(Level& level, std::uint32_t id);
  void grow_table(Level& level);

  template <class Visit>
  void overlapping_on(const Level& level, std::uint32_t id, Visit&& visit) const {
    const Aabb& box = boxes_[id];
    const RoughBox wanted = entries_[id].rough;
    std::array<std::int64_t, 3> lo, hi;
    for (int i = 0; i < 3; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      lo[k] = level.cell(box.lo[i] - level.reach[i]);
      // around the table once is everywhere
      hi[k] = std::min(level.cell(box.hi[i] + level.reach[i]), lo[k] + (1 << level.bits) - 1);
    }
    for (std::int64_t x = lo[0]; x <= hi[0]; ++x)
      for (std::int64_t y = lo[1]; y <= hi[1]; ++y)
        for (std::int64_t z = lo[2]; z <= hi[2]; ++z)
          for (std::uint32_t other = level.first[level.bucket(x, y, z)]; other != nobody;) {
            const Entry& entry = entries_[other];
            if (entry.rough.overlaps(wanted) && other != id && boxes_[other].overlaps(box))
              visit(other);
            other = entry.next;
          }
  }

  std::vector<Aabb> boxes_;
  std::vector<Entry> entries_;
  std::vector<Level> levels_;       // those in use, few
  std::size_t count_ = 0;
};

inline std::int64_t SpatialHash::Level::cell(double coordinate) const {
  // beyond the rim all cells are one: more candidates, none lost
  const double rim = 0x1p50;
  return static_cast<std::int64_t>(std::floor(std::clamp(coordinate * per_cell, -rim, rim)));
}

}  // namespace tw
