// Test mode: every discontinuity is taken back once; that must leave no trace, and what is found
// again must be what it was.
//
// What was taken back is known by its key and by the states that it follows: another history may
// have an impact at the same time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <unordered_map>

#include "kernel/check/state-image.h"

namespace tw {

struct Simulation;

class UndoRedo {
 public:
  explicit UndoRedo(const Simulation& simulation) : sim_(simulation) {}

  // Whether the discontinuity just entered was taken back before; then it must be as it was:
  // assertion "redoing KEY gave another FIELD of BODY: VALUE, before VALUE".
  bool redone(const Key& key);
  // After it was taken back: assertion "undoing KEY left a trace".
  void require_no_trace(const Key& key, std::uint64_t checksum_before) const;
  void forget() { undone_.clear(); }

 private:
  std::uint64_t name_of(const Key& key) const;

  struct Undone {
    double time;
    StateImage image;
  };
  const Simulation& sim_;
  std::unordered_map<std::uint64_t, Undone> undone_;  // by name
};

}  // namespace tw
