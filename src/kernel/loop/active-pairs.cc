// The table of active pairs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/active-pairs.h"

#include <algorithm>

namespace tw {

std::uint32_t ActivePairs::find(BodyId a, BodyId b) const {
  const auto &of_a = of(a), &of_b = of(b);
  const BodyId x = std::min(a, b), y = std::max(a, b);
  for (const std::uint32_t index : of_a.size() <= of_b.size() ? of_a : of_b)
    if (records_[index].a == x && records_[index].b == y) return index;
  return none;
}

std::uint32_t ActivePairs::make(BodyId a, BodyId b, const Key& from) {
  std::uint32_t index;
  if (unused_.empty()) {
    index = static_cast<std::uint32_t>(records_.size());
    records_.emplace_back();
  } else {
    index = unused_.back();
    unused_.pop_back();
  }
  Pair& pair = records_[index];
  pair = Pair();
  pair.live = true;
  pair.a = std::min(a, b);
  pair.b = std::max(a, b);
  pair.from = from;
  const auto enlist = [&](BodyId body) {
    std::vector<std::uint32_t>& list = by_body_[body];
    list.push_back(index);
    return static_cast<std::uint32_t>(list.size() - 1);
  };
  pair.place_a = enlist(pair.a);
  pair.place_b = enlist(pair.b);
  ++live_;
  return index;
}

void ActivePairs::drop(std::uint32_t index) {
  Pair& pair = records_[index];
  queue_.withdraw(pair.event);
  const auto take_out = [&](BodyId body, std::uint32_t place) {
    std::vector<std::uint32_t>& list = by_body_[body];
    const std::uint32_t moved = list.back();
    list[place] = moved;
    list.pop_back();
    if (moved == index) return;
    (records_[moved].a == body ? records_[moved].place_a : records_[moved].place_b) = place;
  };
  take_out(pair.a, pair.place_a);
  take_out(pair.b, pair.place_b);
  pair.live = false;
  pair.caches.clear();
  unused_.push_back(index);
  --live_;
}

void ActivePairs::drop_all_of(BodyId body) {
  while (!of(body).empty()) drop(of(body).back());
}

void ActivePairs::drop_all() {
  for (std::uint32_t i = 0; i < records_.size(); ++i)
    if (records_[i].live) drop(i);
}

}  // namespace tw
