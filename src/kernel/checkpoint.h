// A checkpoint: what World::checkpoint keeps and World::restore brings back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "kernel/counters.h"
#include "kernel/due.h"
#include "timeline/key.h"
#include "timeline/state.h"

namespace tw {

class Kernel;

struct Checkpoint {
  Checkpoint();
  ~Checkpoint();

  const Kernel* owner = nullptr;
  double time = 0;
  Due due;
  bool begun = false;
  Counters counters;
  std::uint64_t hash_sum = 0, hash_count = 0, edits = 0, removals = 0;
  Vec3 gravity = Vec3::Zero();
  // by body: the last committed one, and what edits have added to it
  struct Kept {
    Key key;
    bool committed = false;
    StateData data;
  };
  std::vector<std::vector<Kept>> states;
  std::vector<std::pair<Key, double>> callbacks;  // next tick; next time without a period
};

}  // namespace tw
