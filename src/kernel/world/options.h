// How a world is run; the answer depends on the seed alone.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tw {

// Test modes of the scheduler (HACKING.md): the committed history must not depend on them.
struct AdversaryOptions {
  std::uint64_t seed = 0;
  double head_start = 0;     // s: events are taken as if up to this much earlier
  double body_share = 0.3;   // share of bodies with a head start of their own
  bool every_event = false;  // every event draws a fresh head start
  bool some_bodies = true;
};

struct WorldOptions {
  std::uint64_t seed = 0;
  int threads = 0;            // that loops are shared among; 0: as many as there are cores
  bool hash = false;          // accumulate the hash of the committed history
  bool check = false;         // run every validator after every event
  bool undo_redo = false;     // test mode: undo every discontinuity and redo it
  long gvt_interval = 0;      // events between computations of GVT; 0: automatic
  double window_cells = 0.7;  // claimed window, in cells of travel
  std::optional<AdversaryOptions> adversary;
  std::string write_states;    // test mode: the file for every committed state (state-trace.h)
  std::string compare_states;  // test mode: the file to compare them with
};

}  // namespace tw
