// What was decided ahead.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/decided-ahead.h"

#include <algorithm>
#include <utility>

namespace tw {
namespace {

constexpr auto before = [](const std::unique_ptr<Decision>& decision, const Key& key) {
  return decision->key < key;
};

}  // namespace

std::size_t DecidedAhead::add(std::vector<std::unique_ptr<Decision>> decisions) {
  std::size_t added = 0;
  for (std::unique_ptr<Decision>& decision : decisions) {
    if (!decision) continue;
    ++added;
    const auto at = std::lower_bound(decisions_.begin(), decisions_.end(), decision->key, before);
    if (at != decisions_.end() && (*at)->key == decision->key)
      *at = std::move(decision);
    else
      decisions_.insert(at, std::move(decision));
  }
  return added;
}

bool DecidedAhead::has_at(double time) const {
  const auto at = std::lower_bound(decisions_.begin(), decisions_.end(), Key{time}, before);
  return at != decisions_.end() && (*at)->key.time == time;
}

std::unique_ptr<Decision> DecidedAhead::take(const Key& key, const StateGraph& graph) {
  const auto at = std::lower_bound(decisions_.begin(), decisions_.end(), key, before);
  if (at == decisions_.end() || (*at)->key != key) return nullptr;
  std::unique_ptr<Decision> decision = std::move(*at);
  decisions_.erase(at);
  return decision->log.holds(graph, key) ? std::move(decision) : nullptr;
}

void DecidedAhead::forget_before(double time) {
  const auto end = std::find_if(decisions_.begin(), decisions_.end(),
                                [&](const auto& decision) { return decision->key.time >= time; });
  decisions_.erase(decisions_.begin(), end);
}

}  // namespace tw
