// Pair checks: follows active pairs along their pieces to their first impact.
//
// Cost: a query or certificate a check; how many, see detect/certificate.h.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "detect/certificate.h"
#include "kernel/loop/pieces.h"
#include "kernel/report/counters.h"

namespace tw {

class ActivePairs;
struct Pair;
struct Simulation;
class Travels;

// What becomes of a pair that was followed: all that others may see of it.
struct PairOutcome {
  enum class Kind : std::uint8_t {
    nothing,
    wait,      // for a claim, or for ever: it has no event
    schedule,  // its event, at the key
    drop,      // nothing will happen on these arcs: the next claim asks again
    alone      // this is not for a helper: it is to be followed by whoever works for the world
  };
  Kind kind = Kind::nothing;
  Key key;
};

// Two bodies whose boxes overlap since one of them claimed its last window.
struct Meeting {
  BodyId a = 0, b = 0;
  Key from;              // the lesser of what they had claimed before
  std::uint32_t pair{};  // its record, once there is one
  bool is_new = false;   // it is to have one
  PairOutcome outcome;
  PairCounts counts;
};

class PairChecks {
 public:
  PairChecks(Simulation& simulation, ActivePairs& pairs);

  // Those that meet become pairs, but for those who are in contact or will certainly never meet;
  // pairs that waited for a claim are followed on.  No two bodies meet twice.
  void meet(std::vector<Meeting>& meetings);
  // Moves the safe time up as far as the event's time, over as many pieces as it takes.
  void pursue(std::uint32_t index);
  // After a rollback of one of its bodies to `key`: what was known from there on is forgotten.
  void reset(std::uint32_t index, const Key& key);
  // How many impacts were found so far, those that were forgotten included.
  std::uint64_t impacts_found() const { return impacts_found_; }

 private:
  const State& tail_of(BodyId body) const;
  std::uint32_t make(BodyId a, BodyId b, const Key& from);
  void schedule(std::uint32_t index, const Key& key);
  void look_up(Meeting& meeting) const;
  void apply(std::uint32_t index, const PairOutcome& outcome);
  // These write to the pair alone and read what stands; several pairs may be followed at once by
  // helpers, which leave alone what completes arcs as it looks.
  PairOutcome follow(Pair& pair, PairCounts& counts, bool as_helper, const Travels& travels) const;
  std::optional<PairOutcome> follow_exact(Pair& pair, const Piece& piece, PairCounts& counts) const;
  std::optional<PairOutcome> follow_on_grid(Pair& pair, const Piece& piece, double until,
                                            const SeenApart& seen, PairCounts& counts) const;
  std::optional<PairOutcome> decided(Pair& pair, const Piece& piece) const;
  std::optional<PairOutcome> next_piece(Pair& pair, const Piece& piece) const;
  bool check_common_start(Pair& pair, const Piece& piece, const SeenApart& seen,
                          PairCounts& counts) const;
  bool check_grid_point(Pair& pair, const Piece& piece, double when, PairCounts& counts) const;
  bool find_crossing(Pair& pair, const Piece& piece, double start, double when, double right) const;
  bool check_between(Pair& pair, const Piece& piece, double from, PairCounts& counts) const;
  void raise_safe_time(Pair& pair, const Piece& piece, double checked) const;

  Simulation& sim_;
  Counters& counters_;
  ActivePairs& pairs_;
  Pieces pieces_;
  std::uint64_t impacts_found_ = 0;
};

}  // namespace tw
