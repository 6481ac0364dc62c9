// Active pairs: the record of a pair of bodies whose swept boxes overlap.
//
// Exactly predicted pairs have a record only while an impact is pending; pairs checked on the grid
// have one as long as their boxes overlap.  A pair with a member of a moving group has no events of
// its own but pending impacts: it is followed to the lesser claim whenever one of the two claims a
// window. A pair in contact within a group needs no record at all.  `from` is a key: everything
// before it is known to be free of impacts on the arcs that stand; its time is the pair's safe
// time.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "detect/certificate.h"
#include "detect/clearance.h"
#include "timeline/event-queue.h"
#include "timeline/key.h"

namespace tw {

struct Pair {
  std::uint32_t a = 0, b = 0;              // body ids, a < b
  std::uint32_t place_a = 0, place_b = 0;  // index in each body's list
  Key from;                                // safe time, as a key
  Key checked_start;                       // start of the piece whose common start has been checked
  double next_check = 0;                   // grid time of the next query on this piece
  double touch = 0;         // depth that counts as touching on this piece, m; 0: not asked yet
  std::uint64_t looks = 0;  // at grid points, for statistics
  bool started = false;     // these three hold for the present piece
  bool pending = false;     // an impact is known:
  Key impact;
  bool parked = false;  // one of the processes has stopped
  EventQueue::Handle event = EventQueue::none;
  double head_start = 0;  // adversary scheduler
  bool live = false;      // the record is in use
  SimplexCaches caches;   // per pair of parts, where polyhedra are concerned

  Clearance clearance;

  double safe_time() const { return pending ? impact.time : from.time; }
};

}  // namespace tw
