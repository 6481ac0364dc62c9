// A hierarchical spatial hash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/spatial-hash.h"

namespace tw {
namespace {

// Cell edges from 2^-40 to 2^55 m; what is larger or smaller shares the end's cells.
constexpr int least_exponent = -40, greatest_exponent = 55;

// A table has at least this many buckets for each box.
constexpr std::size_t buckets_per_box = 2;

}  // namespace

// Of the finest level with cell edge >= the box's longest edge.
int SpatialHash::exponent_of(const Aabb& box) {
  int exponent = 0;
  std::frexp(box.size().maxCoeff(), &exponent);  // longest < 2^exponent
  return std::clamp(exponent, least_exponent, greatest_exponent);
}

SpatialHash::RoughBox SpatialHash::rough(const Aabb& box) {
  // one conversion and one sum are off by at most 2^-24 of the magnitude each
  const auto down = [](double x) {
    const float f = static_cast<float>(x);
    return f - std::abs(f) * 0x1p-22f - 0x1p-126f;
  };
  RoughBox result;
  for (int i = 0; i < 3; ++i) {
    result.lo[static_cast<std::size_t>(i)] = down(box.lo[i]);
    result.hi[static_cast<std::size_t>(i)] = -down(-box.hi[i]);
  }
  return result;
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
  std::uint32_t& first = level.first[entry.bucket];
  entry.next = first;
  entry.previous = nobody;
  if (first != nobody) entries_[first].previous = id;
  first = id;
}

void SpatialHash::unlink(Level& level, std::uint32_t id) {
  const Entry& entry = entries_[id];
  std::uint32_t& link_to_it =
      entry.previous == nobody ? level.first[entry.bucket] : entries_[entry.previous].next;
  link_to_it = entry.next;
  if (entry.next != nobody) entries_[entry.next].previous = entry.previous;
}

void SpatialHash::place(std::uint32_t id, const Aabb& box) {
  if (id >= entries_.size()) {
    entries_.resize(id + 1);
    boxes_.resize(id + 1);
  }
  Entry& entry = entries_[id];
  int exponent = exponent_of(box);
  // a box that shrank a little stays where it is: levels would flap otherwise
  if (entry.present && exponent == entry.level - 1) exponent = entry.level;
  if (entry.present && exponent != entry.level) remove(id);

  boxes_[id] = box;
  entry.rough = rough(box);
  Level& level = level_at(exponent);
  level.reach = level.reach.cwiseMax(0.5 * box.size());
  const Vec3 center = box.center();
  const std::size_t bucket =
      level.bucket(level.cell(center[0]), level.cell(center[1]), level.cell(center[2]));
  if (entry.present && bucket == entry.bucket) return;

  if (entry.present) {
    unlink(level, id);
  } else {
    entry.present = true;
    entry.level = static_cast<std::int16_t>(exponent);
    ++level.count;
    ++count_;
  }
  entry.bucket = static_cast<std::uint32_t>(bucket);
  link(level, id);
  if (level.count * buckets_per_box > level.first.size()) grow_table(level);
}

void SpatialHash::remove(std::uint32_t id) {
  if (id >= entries_.size() || !entries_[id].present) return;
  Level& level = level_at(entries_[id].level);
  unlink(level, id);
  entries_[id].present = false;
  --level.count;
  --count_;
}

void SpatialHash::grow_table(Level& level) {
  ++level.bits;
  level.first.assign(std::size_t{1} << (3 * level.bits), nobody);
  for (std::uint32_t id = 0; id < entries_.size(); ++id) {
    Entry& entry = entries_[id];
    if (!entry.present || entry.level != level.exponent) continue;
    const Vec3 center = boxes_[id].center();
    entry.bucket = static_cast<std::uint32_t>(
        level.bucket(level.cell(center[0]), level.cell(center[1]), level.cell(center[2])));
    link(level, id);
  }
}

bool SpatialHash::consistent() const {
  std::size_t found = 0;
  for (const Level& level : levels_) {
    std::size_t here = 0;
    for (std::size_t bucket = 0; bucket < level.first.size(); ++bucket)
      for (std::uint32_t id = level.first[bucket]; id != nobody; id = entries_[id].next, ++here) {
        const Entry& entry = entries_[id];
        const Vec3 center = boxes_[id].center();
        if (here > level.count || !entry.present || entry.level != level.exponent) return false;
        if (level.bucket(level.cell(center[0]), level.cell(center[1]), level.cell(center[2])) !=
            bucket)
          return false;
      }
    if (here != level.count) return false;
    found += here;
  }
  return found == count_;
}

}  // namespace tw
