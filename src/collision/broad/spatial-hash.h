// A hierarchical spatial hash over axis-aligned boxes: who may overlap whom.
//
// A box lives on the level whose cells (edge 2^level) just hold it, in the one cell that holds its
// centre.  Boxes of a level with half-extents h that overlap a box B then have their centre in B
// grown by h: a query visits those cells, on each level where somebody lives.  Each level is a
// table of 2^k cells along each axis, wrapped around: cell (x, y, z) is bucket (x, y, z) mod 2^k.
// A query needs at most 2^k cells along an axis and so meets each bucket, and each box, once at
// most; strangers from the other side of the wrap are sorted out by the box test, as neighbours
// are.
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
  bool contains(std::uint32_t id) const { return id < boxes_.size() && residences_[id].present; }
  const Aabb& box(std::uint32_t id) const { return boxes_[id]; }

  // Calls visit(other) once for each other box that overlaps (closed boxes) that of `id`.  The
  // visit must not place or remove boxes.
  template <class Visit>
  void overlapping(std::uint32_t id, Visit&& visit) const {
    for (const Level& level : levels_)
      if (level.count > 0) overlapping_on(level, boxes_[id], entries_[id], id, visit);
  }
  // The same for any box.
  template <class Visit>
  void overlapping(const Aabb& box, Visit&& visit) const {
    Entry rough;
    set_rough(rough, box);
    for (const Level& level : levels_)
      if (level.count > 0) overlapping_on(level, box, rough, nobody, visit);
  }

  std::size_t size() const { return count_; }
  // Every box stands in the bucket that its centre says, once: for validators.
  bool consistent() const;

 private:
  static constexpr std::uint32_t nobody = 0xffffffffu;

  // A box in single precision, outwards: overlaps wherever the true box does; and its place in the
  // bucket's list.  Half a cache line.
  struct alignas(32) Entry {
    std::array<float, 3> lo{}, hi{};
    std::uint32_t next = nobody, previous = nobody;

    // The widest gap along an axis, without jumps: each comparison's outcome is a coin's.
    bool overlaps(const Entry& other) const {
      const float x = std::max(lo[0] - other.hi[0], other.lo[0] - hi[0]);
      const float y = std::max(lo[1] - other.hi[1], other.lo[1] - hi[1]);
      const float z = std::max(lo[2] - other.hi[2], other.lo[2] - hi[2]);
      return std::max(std::max(x, y), z) <= 0;
    }
  };
  struct Residence {
    std::uint32_t bucket = 0;
    int level = 0;  // exponent of the cell edge
    bool present = false;
  };
  struct Level {
    int exponent = 0;
    double per_cell = 1;        // 1 / cell edge
    Vec3 reach = Vec3::Zero();  // the largest half-extents that ever lived here, and a little
    int bits = 2;               // of a cell coordinate in the table
    std::vector<std::uint32_t> first = std::vector<std::uint32_t>(64, nobody);
    std::size_t count = 0;

    // Cell coordinates are numbers mod 2^64: only their low bits count.
    std::uint64_t cell(double coordinate) const;
    std::uint64_t mask() const { return (std::uint64_t{1} << bits) - 1; }
    std::uint64_t row(std::uint64_t x, std::uint64_t y) const {
      return ((x & mask()) << bits | (y & mask())) << bits;
    }
    std::uint64_t bucket_of(const Aabb& box) const;
  };

  static int exponent_of(const Aabb& box);
  static void set_rough(Entry& entry, const Aabb& box);
  Level& level_at(int exponent);
  void link(Level& level, std::uint32_t id);
  void unlink(Level& level, std::uint32_t id);
  void grow_table(Level& level);

  template <class Visit>
  void overlapping_on(const Level& level, const Aabb& box, const Entry wanted, std::uint32_t id,
                      Visit&& visit) const {
    const Entry* const entries = entries_.data();
    const std::uint64_t mask = level.mask();
    std::array<std::uint64_t, 3> first, count;
    for (int i = 0; i < 3; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      // centres are rounded
      const double reach = level.reach[i] + 0x1p-50 * (std::abs(box.lo[i]) + std::abs(box.hi[i]));
      first[k] = level.cell(box.lo[i] - reach);
      // around the table once is everywhere
      count[k] = std::min(level.cell(box.hi[i] + reach) - first[k], level.mask()) + 1;
    }
    for (std::uint64_t x = 0; x < count[0]; ++x)
      for (std::uint64_t y = 0; y < count[1]; ++y) {
        const std::uint32_t* const row = &level.first[level.row(first[0] + x, first[1] + y)];
        for (std::uint64_t z = 0; z < count[2]; ++z)
          for (std::uint32_t other = row[(first[2] + z) & mask]; other != nobody;) {
            const Entry& entry = entries[other];
            if (entry.overlaps(wanted) && other != id && boxes_[other].overlaps(box)) visit(other);
            other = entry.next;
          }
      }
  }

  std::vector<Aabb> boxes_;
  std::vector<Entry> entries_;
  std::vector<Residence> residences_;
  std::vector<Level> levels_;  // those in use, few
  std::size_t count_ = 0;
};

inline std::uint64_t SpatialHash::Level::cell(double coordinate) const {
  // beyond the rim all cells are one: more candidates, none lost
  const double rim = 0x1p50;
  const double inside = std::min(std::max(coordinate * per_cell, -rim), rim);
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(inside)));
}

}  // namespace tw
