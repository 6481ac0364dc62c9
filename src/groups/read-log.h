// Which states a decision was made of: it holds for as long as they are still the last ones before
// its key.
//
// Source: validation in optimistic concurrency control (Kung, Robinson 1981).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "timeline/state-graph.h"

namespace tw {

class ReadLog {
 public:
  // Thrown where a state is read that may not be.
  struct Unreadable {};
  using MayRead = std::function<bool(const State&)>;

  // From here on only those may be read of which that is so.
  void restrict_to(MayRead may_read) { may_read_ = std::move(may_read); }
  // Loops within a decision may read at once.
  void note(const State& state) {
    if (may_read_ && !may_read_(state)) throw Unreadable();
    while (busy_.test_and_set(std::memory_order_acquire)) {
    }
    if (read_.empty() || read_.back().first != state.process)
      read_.emplace_back(state.process, state.entered);
    busy_.clear(std::memory_order_release);
  }
  // The decision is made.
  void close() {
    std::sort(read_.begin(), read_.end());
    read_.erase(std::unique(read_.begin(), read_.end()), read_.end());
  }
  bool holds(const StateGraph& graph, const Key& key) const {
    return std::all_of(read_.begin(), read_.end(), [&](const auto& read) {
      const State* now = graph.last_before(read.first, key);
      return now && now->entered == read.second && (!may_read_ || may_read_(*now));
    });
  }

 private:
  MayRead may_read_;
  std::atomic_flag busy_;
  std::vector<std::pair<ProcessId, std::uint64_t>> read_;  // whose, the how manieth state
};

}  // namespace tw
