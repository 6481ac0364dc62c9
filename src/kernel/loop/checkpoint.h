// A checkpoint: what World::checkpoint keeps and World::restore brings back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "kernel/loop/callback-book.h"
#include "kernel/loop/present.h"
#include "kernel/report/delivery.h"
#include "kernel/world/bodies.h"
#include "timeline/state.h"

namespace tw {

class Kernel;

struct Checkpoint {
  const Kernel* owner = nullptr;
  Present present;
  Bodies::Kept bodies;
  // by body: the last committed one, and what edits have added to it
  struct Kept {
    Key key;
    bool committed = false;
    StateData data;
  };
  std::vector<std::vector<Kept>> states;
  std::vector<CallbackRecord> callbacks;
  std::vector<CollisionCallbackDef> collision_callbacks;
  Delivery::Kept watchers;
};

}  // namespace tw
