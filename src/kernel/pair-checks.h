// Pair checks: follows active pairs along their pieces to their first impact.
//
// Cost: a query or certificate a check; how many, see detect/certificate.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "kernel/counters.h"
#include "kernel/pieces.h"

namespace tw {

class ActivePairs;
struct Pair;
struct Simulation;

class PairChecks {
 public:
  PairChecks(Simulation& simulation, ActivePairs& pairs);

  // The boxes of two overlap since a claimed its last window; before that it had claimed up to the
  // key.  They become a pair from the lesser claim on, but none where they are in contact or will
  // certainly never meet.  A pair that waited for a claim is followed on.
  void meet(const Body& a, const Body& b, const Key& claimed_before);
  // Moves the safe time up as far as the event's time, over as many pieces as it takes.
  void pursue(std::uint32_t index);
  // After a rollback of one of its bodies to `key`: what was known from there on is forgotten.
  void reset(std::uint32_t index, const Key& key);

 private:
  const State& tail_of(BodyId body) const;
  std::uint32_t make(const Body& a, const Body& b, const Key& from);
  void schedule(std::uint32_t index, const Key& key);
  void schedule_check(std::uint32_t index, double when);
  void set_pending(std::uint32_t index, const Key& key);
  bool next_piece(Pair& pair, const Piece& piece);
  bool pursue_exact(std::uint32_t index, const Piece& piece);
  bool pursue_on_grid(std::uint32_t index, const Piece& piece, double until);
  bool check_common_start(Pair& pair, const Piece& piece);
  bool check_grid_point(Pair& pair, const Piece& piece, double when);
  bool find_crossing(Pair& pair, const Piece& piece, double start, double when) const;
  bool check_between(Pair& pair, const Piece& piece, double from);
  void raise_safe_time(Pair& pair, const Piece& piece, double checked) const;

  Simulation& sim_;
  Counters& counters_;
  ActivePairs& pairs_;
  Pieces pieces_;
};

}  // namespace tw
