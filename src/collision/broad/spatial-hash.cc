// A hierarchical spatial hash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/broad/spatial-hash.h"

#include "base/constants.h"

namespace tw {
namespace {

// Cell edges from 2^-40 to 2^55 m; what is larger or smaller shares the end's cells.
constexpr int least_exponent = -40, greatest_exponent = 55;

}  // namespace

// Of the finest level with cell edge >= the box's longest edge.
int SpatialHash::exponent_of(const Aabb& box) {
  int exponent = 0;
  std::frexp(box.size().maxCoeff(), &exponent);  // longest < 2^exponent
  return std::clamp(exponent, least_exponent, greatest_exponent);
}

void SpatialHash::set_rough(Entry& entry, const Aabb& box) {
  // one conversion and one sum are off by at most 2^-24 of the magnitude each; what is beyond the
  // rim counts as at the rim
  const auto down = [](double x) {
    const double rim = 0x1p126;
    const float f = static_cast<float>(std::min(std::max(x, -rim), rim));
    return f - std::abs(f) * 0x1p-22f - 0x1p-126f;
  };
  for (int i = 0; i < 3; ++i) {
    entry.lo[static_cast<std::size_t>(i)] = down(box.lo[i]);
    entry.hi[static_cast<std::size_t>(i)] = -down(-box.hi[i]);
  }
}

std::uint64_t SpatialHash::Level::bucket_of(const Aabb& box) const {
  const Vec3 center = box.center();
  return row(cell(center[0]), cell(center[1])) | (cell(center[2]) & mask());
}

SpatialHash::Level& SpatialHash::level_at(int exponent) {
  for (Level& level : levels_)
    if (level.exponent == exponent) return level;
  Level& level = levels_.emplace_back();
  level.exponent = exponent;
  level.per_cell = std::ldexp(1.0, -exponent);
  return level;
}

void SpatialHash::link(Level& level, std::uint32_t id) {
  Entry& entry = entries_[id];
  std::uint32_t& first = level.first[residences_[id].bucket];
  entry.next = first;
  entry.previous = nobody;
  if (first != nobody) entries_[first].previous = id;
  first = id;
}

void SpatialHash::unlink(Level& level, std::uint32_t id) {
  const Entry& entry = entries_[id];
  std::uint32_t& link_to_it = entry.previous == nobody ? level.first[residences_[id].bucket]
                                                       : entries_[entry.previous].next;
  link_to_it = entry.next;
  if (entry.next != nobody) entries_[entry.next].previous = entry.previous;
}

void SpatialHash::place(std::uint32_t id, const Aabb& box) {
  if (id >= boxes_.size()) {
    boxes_.resize(id + 1);
    entries_.resize(id + 1);
    residences_.resize(id + 1);
  }
  Residence& residence = residences_[id];
  int exponent = exponent_of(box);
  // a box that shrank a little stays where it is: levels would flap otherwise
  if (residence.present && exponent == residence.level - 1 &&
      box.size().maxCoeff() > std::ldexp(cost::stays_above, exponent))
    exponent = residence.level;
  if (residence.present && exponent != residence.level) remove(id);

  boxes_[id] = box;
  set_rough(entries_[id], box);
  Level& level = level_at(exponent);
  level.reach = level.reach.cwiseMax((0.5 + 0x1p-48) * box.size());
  const std::uint32_t bucket = static_cast<std::uint32_t>(level.bucket_of(box));
  if (residence.present && bucket == residence.bucket) return;

  if (residence.present) {
    unlink(level, id);
  } else {
    ++level.count;
    ++count_;
  }
  residence = {bucket, exponent, true};
  link(level, id);
  if (level.count * cost::buckets_per_box > level.first.size()) grow_table(level);
}

void SpatialHash::remove(std::uint32_t id) {
  if (id >= residences_.size() || !residences_[id].present) return;
  Level& level = level_at(residences_[id].level);
  unlink(level, id);
  residences_[id].present = false;
  --level.count;
  --count_;
}

void SpatialHash::grow_table(Level& level) {
  ++level.bits;
  level.first.assign(std::size_t{1} << (3 * level.bits), nobody);
  for (std::uint32_t id = 0; id < residences_.size(); ++id) {
    Residence& residence = residences_[id];
    if (!residence.present || residence.level != level.exponent) continue;
    residence.bucket = static_cast<std::uint32_t>(level.bucket_of(boxes_[id]));
    link(level, id);
  }
}

bool SpatialHash::consistent() const {
  std::size_t found = 0;
  for (const Level& level : levels_) {
    std::size_t here = 0;
    for (std::size_t bucket = 0; bucket < level.first.size(); ++bucket)
      for (std::uint32_t id = level.first[bucket]; id != nobody; id = entries_[id].next) {
        const Residence& residence = residences_[id];
        if (++here > level.count || !residence.present) return false;
        if (residence.level != level.exponent || residence.bucket != bucket) return false;
        if (level.bucket_of(boxes_[id]) != bucket) return false;
      }
    if (here != level.count) return false;
    found += here;
  }
  return found == count_;
}

}  // namespace tw
