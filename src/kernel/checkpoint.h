// A checkpoint: what World::checkpoint keeps and World::restore brings back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "kernel/present.h"
#include "timeline/state.h"

namespace tw {

class Kernel;

struct Checkpoint {
  const Kernel* owner = nullptr;
  Present present;
  unsigned contact_rules = 0;  // version of the contact parameters: they are the scene's, and stay
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
