// Which processes' states a decision was made of: it holds for as long as none of their queues has
// changed.
//
// Source: versions, as in optimistic concurrency control (Kung, Robinson 1981).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "timeline/state-graph.h"

namespace tw {

class ReadLog {
 public:
  // Loops within a decision may read at once.
  void note(ProcessId process) {
    while (busy_.test_and_set(std::memory_order_acquire)) {
    }
    if (read_.empty() || read_.back() != process) read_.push_back(process);
    busy_.clear(std::memory_order_release);
  }
  // The decision is made: as the queues are now.
  void close(const StateGraph& graph) {
    std::sort(read_.begin(), read_.end());
    read_.erase(std::unique(read_.begin(), read_.end()), read_.end());
    for (const ProcessId process : read_) versions_.push_back(graph.version(process));
  }
  bool holds(const StateGraph& graph) const {
    for (std::size_t i = 0; i < read_.size(); ++i)
      if (graph.version(read_[i]) != versions_[i]) return false;
    return true;
  }

 private:
  std::atomic_flag busy_;
  std::vector<ProcessId> read_;
  std::vector<std::uint64_t> versions_;
};

}  // namespace tw
