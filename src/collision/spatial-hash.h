// A hierarchical spatial hash over axis-aligned boxes: who may overlap whom.
//
// Each box lives on the level whose cells (edge 2^level) just hold it, so it covers at most eight of
// them; on every coarser level in use it leaves marks, so that large boxes find small ones and small
// ones find large ones without visiting fine cells one by one.  Buckets are shared by all levels;
// strangers in a bucket are sorted out by the box test, repeats by a stamp.  A level once used stays
// in use.
//
// Source: B. Mirtich, "Efficient algorithms for two-phase collision detection", MERL TR-97-23 (the
// hash of the paper's appendix A).
// Cost: an insertion writes 8 buckets a level; a query reads the same ones.  Levels in use are few.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/aabb.h"

namespace tw {

class SpatialHash {
 public:
  // Inserts or moves box `id` (dense numbers from 0).  Must be finite and not empty.
  void place(std::uint32_t id, const Aabb& box);
  void remove(std::uint32_t id);
  const Aabb& box(std::uint32_t id) const { return entries_[id].box; }

  // Calls visit(other) once for each other box that overlaps (closed boxes) that of `id`.
  template <class Visit>
  void overlapping(std::uint32_t id, Visit&& visit) {
    const Entry& self = entries_[id];
    ++stamp_;
    entries_[id].stamp = stamp_;
    // own level: residents and the marks of finer boxes; coarser levels: residents alone
    for (int level = self.level; level <= coarsest_; ++level) {
      if (!level_used_[index(level)]) continue;
      const CellRange range = level == self.level ? self.cells : cells_of(self.box, level);
      for_each_bucket(range, level, [&](Bucket& bucket) {
        visit_list(bucket.residents, self.box, visit);
        if (level == self.level) visit_list(bucket.marks, self.box, visit);
      });
    }
  }

  std::size_t size() const { return count_; }
  // Every entry stands in exactly the buckets that its box says: for validators.
  bool consistent() const;

 private:
  struct CellRange {
    std::array<std::int64_t, 3> lo{}, hi{};
    bool operator==(const CellRange&) const = default;
  };
  struct Entry {
    Aabb box;
    CellRange cells;
    int level = 0;
    std::uint32_t stamp = 0;
    bool present = false;
  };
  struct Bucket {
    std::vector<std::uint32_t> residents;
    std::vector<std::uint32_t> marks;
  };
  static constexpr int least_level = -40, level_span = 96;

  static std::size_t index(int level) { return static_cast<std::size_t>(level - least_level); }
  static int level_of(const Aabb& box);
  static CellRange cells_of(const Aabb& box, int level);
  std::size_t bucket_of(std::int64_t x, std::int64_t y, std::int64_t z, int level) const;
  void enter(std::uint32_t id);
  void leave(std::uint32_t id);
  void mark(std::uint32_t id, int level);
  void unmark(std::uint32_t id, int level);
  bool same_cells(const Entry& entry, const Aabb& box, int level) const;
  void grow_table();
  void level_comes_into_use(int level);

  template <class F>
  void for_each_bucket(const CellRange& r, int level, F&& f) {
    for (std::int64_t x = r.lo[0]; x <= r.hi[0]; ++x)
      for (std::int64_t y = r.lo[1]; y <= r.hi[1]; ++y)
        for (std::int64_t z = r.lo[2]; z <= r.hi[2]; ++z) f(buckets_[bucket_of(x, y, z, level)]);
  }
  template <class Visit>
  void visit_list(const std::vector<std::uint32_t>& list, const Aabb& box, Visit&& visit) {
    for (const std::uint32_t other : list) {
      Entry& entry = entries_[other];
      if (entry.stamp == stamp_) continue;
      if (!entry.box.overlaps(box)) continue;
      entry.stamp = stamp_;
      visit(other);
    }
  }

  std::vector<Entry> entries_;
  std::vector<Bucket> buckets_ = std::vector<Bucket>(256);
  std::array<bool, level_span> level_used_{};  // somebody resided there once
  int coarsest_ = least_level - 1;
  std::size_t count_ = 0;
  std::uint32_t stamp_ = 0;
};

}  // namespace tw
