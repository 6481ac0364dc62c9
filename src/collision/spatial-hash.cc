// A hierarchical spatial hash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/spatial-hash.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/hash.h"

namespace tw {
namespace {

void erase_one(std::vector<std::uint32_t>& list, std::uint32_t id) {
  const auto at = std::find(list.begin(), list.end(), id);
  TW_ASSERT(at != list.end(), "spatial hash lost box " + std::to_string(id));
  *at = list.back();
  list.pop_back();
}

}  // namespace

int SpatialHash::level_of(const Aabb& box) {
  // the finest level with cell edge >= the box's longest edge
  const double longest = box.size().maxCoeff();
  int exponent = 0;
  std::frexp(longest, &exponent);  // longest < 2^exponent
  return std::clamp(exponent, least_level, least_level + level_span - 1);
}

SpatialHash::CellRange SpatialHash::cells_of(const Aabb& box, int level) {
  CellRange range;
  const double scale = std::ldexp(1.0, -level);
  for (int i = 0; i < 3; ++i) {
    // far from the origin cells merge at the rim: more candidates, none lost
    const double rim = 0x1p50;
    range.lo[static_cast<std::size_t>(i)] =
        static_cast<std::int64_t>(std::floor(std::clamp(box.lo[i] * scale, -rim, rim)));
    range.hi[static_cast<std::size_t>(i)] =
        static_cast<std::int64_t>(std::floor(std::clamp(box.hi[i] * scale, -rim, rim)));
  }
  return range;
}

std::size_t SpatialHash::bucket_of(std::int64_t x, std::int64_t y, std::int64_t z,
                                   int level) const {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ull;
  h ^= static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4full;
  h ^= static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ull;
  h += static_cast<std::uint64_t>(level) * 0x27d4eb2f165667c5ull;
  h ^= h >> 29;
  h *= 0xbf58476d1ce4e5b9ull;
  return static_cast<std::size_t>(h >> 32) & (buckets_.size() - 1);
}

void SpatialHash::mark(std::uint32_t id, int level) {
  for_each_bucket(cells_of(entries_[id].box, level), level,
                  [&](Bucket& bucket) { bucket.marks.push_back(id); });
}

void SpatialHash::unmark(std::uint32_t id, int level) {
  for_each_bucket(cells_of(entries_[id].box, level), level,
                  [&](Bucket& bucket) { erase_one(bucket.marks, id); });
}

// A level nobody ever lived on needs no marks; its first resident makes every finer box leave some.
void SpatialHash::level_comes_into_use(int level) {
  level_used_[index(level)] = true;
  coarsest_ = std::max(coarsest_, level);
  for (std::uint32_t id = 0; id < entries_.size(); ++id)
    if (entries_[id].present && entries_[id].level < level) mark(id, level);
}

void SpatialHash::enter(std::uint32_t id) {
  Entry& entry = entries_[id];
  if (!level_used_[index(entry.level)]) level_comes_into_use(entry.level);
  for_each_bucket(entry.cells, entry.level,
                  [&](Bucket& bucket) { bucket.residents.push_back(id); });
  for (int level = entry.level + 1; level <= coarsest_; ++level)
    if (level_used_[index(level)]) mark(id, level);
  entry.present = true;
  ++count_;
}

void SpatialHash::leave(std::uint32_t id) {
  Entry& entry = entries_[id];
  entry.present = false;
  --count_;
  for (int level = entry.level + 1; level <= coarsest_; ++level)
    if (level_used_[index(level)]) unmark(id, level);
  for_each_bucket(entry.cells, entry.level, [&](Bucket& bucket) { erase_one(bucket.residents, id); });
}

// True if the entry may keep all its buckets for the new box.
bool SpatialHash::same_cells(const Entry& entry, const Aabb& box, int level) const {
  if (!entry.present || level != entry.level) return false;
  for (int l = level; l <= coarsest_; ++l)
    if (level_used_[index(l)] && !(cells_of(box, l) == cells_of(entry.box, l))) return false;
  return true;
}

void SpatialHash::place(std::uint32_t id, const Aabb& box) {
  if (id >= entries_.size()) entries_.resize(id + 1);
  Entry& entry = entries_[id];
  int level = level_of(box);
  // a box that shrank a little stays where it is: levels would flap otherwise
  if (entry.present && level == entry.level - 1) level = entry.level;

  if (same_cells(entry, box, level)) {
    entry.box = box;
    return;
  }
  if (entry.present) leave(id);
  entry.box = box;
  entry.level = level;
  entry.cells = cells_of(box, level);
  enter(id);
  if (count_ * 16 > buckets_.size()) grow_table();
}

void SpatialHash::remove(std::uint32_t id) {
  if (id < entries_.size() && entries_[id].present) leave(id);
}

void SpatialHash::grow_table() {
  const std::size_t size = buckets_.size() * 4;
  buckets_.assign(size, {});
  for (std::uint32_t id = 0; id < entries_.size(); ++id) {
    if (!entries_[id].present) continue;
    const Entry& entry = entries_[id];
    for_each_bucket(entry.cells, entry.level,
                    [&](Bucket& bucket) { bucket.residents.push_back(id); });
    for (int level = entry.level + 1; level <= coarsest_; ++level)
      if (level_used_[index(level)]) mark(id, level);
  }
}

bool SpatialHash::consistent() const {
  std::size_t residents = 0, expected = 0;
  for (const Bucket& bucket : buckets_) residents += bucket.residents.size();
  for (const Entry& entry : entries_) {
    if (!entry.present) continue;
    std::size_t cells = 1;
    for (std::size_t i = 0; i < 3; ++i)
      cells *= static_cast<std::size_t>(entry.cells.hi[i] - entry.cells.lo[i] + 1);
    expected += cells;
  }
  return residents == expected;
}

}  // namespace tw
