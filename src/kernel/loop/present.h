// The committed present: what has become of a world so far, as one value.
//
// A checkpoint is a copy of it, with the committed states and the next ticks of callbacks; to
// restore is to assign it and to find the future anew.  So what is added here cannot be forgotten
// in either.  What is *not* here does not depend on what happened, or follows from it: claims,
// boxes, pairs and events are found anew; windows (lonely claims, cell), head starts and the
// adversary's random numbers belong to the schedule, which never changes the answer.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/scene.h"
#include "groups/placed/placed-together.h"
#include "kernel/report/counters.h"
#include "kernel/report/due.h"
#include "timeline/key.h"

namespace tw {

// Of the committed history: a sum over its states, in whatever order they were committed.
struct HistorySum {
  std::uint64_t sum = 0, count = 0;
};

struct Present {
  double time = 0;                        // last committed time, s: what users see
  double gvt = 0;                         // nothing below it is touched any more, s
  Due due;                                // what is final at `time`, and so may be delivered
  bool begun = false;                     // the first run has begun
  std::vector<BodyId> newborn;            // came since the last run: nobody has met them yet
  PlacedTogether together;                // who touched whom where they were put last
  SceneOptions settings;                  // accuracy and methods only before the first run
  std::uint64_t edits = 0, removals = 0;  // number the edits; bodies taken out
  HistorySum history;
  Counters counters;

  // What is below it is past: all that has happened at the present time where that is final, else
  // nothing but what was changed between runs.
  Key key() const {
    if (due.inclusive) return {time, 0xffffffffu, KeyKind::impact, ~0ull};
    return {time, 0, KeyKind::early_edit, ~0ull};
  }
};

}  // namespace tw
