// Pieces: stretches of a pair of bodies over which both arcs stand.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "dynamics/body.h"
#include "timeline/key.h"
#include "timeline/state.h"

namespace tw {

// [start, end) in keys.
struct Piece {
  const State* a = nullptr;
  const State* b = nullptr;
  const Body* body_a = nullptr;
  const Body* body_b = nullptr;
  Key start;  // the later of the two arcs' starts: the common start
  Key end;    // the earlier of the next arcs' starts, or of the arcs' natural ends
  bool ends_naturally = false;  // what follows is not known yet
  double start_time() const { return start.time; }
};

}  // namespace tw
