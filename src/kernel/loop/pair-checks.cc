// Collision checks: the first impact of a pair, on the arcs that stand.
//
// A pair is followed piece by piece (a piece: both arcs stand).  On each piece the impact is a
// function of the two arcs' starts alone, as if they were never cut:
//   exact     spheres that fall alike, sphere and fixed plane: a quadratic (impact-time.h)
//   on grid   otherwise: at the common start, then at multiples of h = 2^-20 s.  A conservative
//             certificate skips grid points at which the pair is surely apart.  The impact lies
//             before the first grid point with penetration, or the first dip between two of them
//             (dip.h); Brent's method finds it on the signed distance, cold.
// An impact found with key K is valid only if K is below the piece's end.  So it does not matter
// when, in which order or how often a pair is checked.
//
// Equality: at the common start, overlapping and approaching is an impact now, overlapping and
// separating is none.  A shallow contact shorter than h that no grid point sees does not exist.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/pair-checks.h"

#include "kernel/loop/horizon.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/parallel.h"
#include "detect/approach.h"
#include "detect/dip.h"
#include "detect/exact-impact.h"
#include "groups/placed/placed-loads.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/simulation.h"
#include "math/root.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

double grid_floor(double t) { return std::floor(t / answer::check_grid) * answer::check_grid; }
double grid_ceil(double t) { return std::ceil(t / answer::check_grid) * answer::check_grid; }
double grid_after(double t) {
  return (std::floor(t / answer::check_grid) + 1) * answer::check_grid;
}

double slack_of(const Scene& scene, const Piece& piece) {
  // what is placed touching is to be found at once, for its loads
  const auto is_integrated = [&](const Body& body, const State& state) {
    return state.trajectory().stepped() && !is_just_placed(scene, body, state, piece.start_time());
  };
  const bool integrated =
      is_integrated(*piece.body_a, *piece.a) && is_integrated(*piece.body_b, *piece.b);
  const Body& a = *piece.body_a;
  const Body& b = *piece.body_b;
  // above rounding, or nothing that touches would surely be apart
  return std::max((integrated ? answer::stepped_slack : answer::depth_slack) *
                      std::min(a.least_width, b.least_width),
                  answer::slack_in_roundings * distance_rounding(a, piece.a->x, b, piece.b->x));
}

// How deep the two may be, m, before it counts as penetration: as deep as they are when the piece
// begins, and a slack.  What begins in each other and does not close (that would be an impact)
// stays so, or parts as slowly as it likes: without this it were looked at at every grid point.
double depth_at_touch(const Scene& scene, Pair& pair, const Piece& piece) {
  if (!(pair.touch > 0)) {
    const double start = distance_at(piece, piece.start_time());
    pair.touch = std::max(-start, 0.0) + slack_of(scene, piece);
  }
  return pair.touch;
}

bool moves_in_group(const State& state) {
  return state.group && state.trajectory().stepped() && !state.error;
}

// ---- outcomes ----

// Poses jump at edits alone: how far apart the two were says nothing of after.
void forget_if_edited(Pair& pair, const Key& key) {
  if (is_edit(key)) pair.clearance = {};
}

constexpr PairOutcome waits{PairOutcome::Kind::wait, {}};

PairOutcome check_at(const Pair& pair, double when) {
  return {PairOutcome::Kind::schedule, {when, 0, KeyKind::step, pair_id(pair.a, pair.b)}};
}

PairOutcome pending_at(Pair& pair, const Key& key) {
  pair.pending = true;
  pair.impact = key;
  return {PairOutcome::Kind::schedule, key};
}

}  // namespace

PairChecks::PairChecks(Simulation& simulation, ActivePairs& pairs)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      pieces_(simulation.scene, simulation.graph) {}

const State& PairChecks::tail_of(BodyId body) const {
  return *sim_.graph.tail(sim_.process_of(body));
}

std::uint32_t PairChecks::make(BodyId a, BodyId b, const Key& from) {
  const std::uint32_t index = pairs_.make(a, b, from);
  pairs_[index].head_start =
      std::max(sim_.process(sim_.body(a)).head_start, sim_.process(sim_.body(b)).head_start);
  ++counters_.pairs_made;
  return index;
}

// ---- events ----

void PairChecks::schedule(std::uint32_t index, const Key& key) {
  Pair& pair = pairs_[index];
  sim_.schedule(pair.event, key, EventKind::pair, index, pair.head_start);
}

void PairChecks::apply(std::uint32_t index, const PairOutcome& outcome) {
  using enum PairOutcome::Kind;
  switch (outcome.kind) {
    case nothing: break;
    case wait: sim_.queue.withdraw(pairs_[index].event); break;
    case schedule:
      impacts_found_ += pairs_[index].pending;
      this->schedule(index, outcome.key);
      break;
    case drop: pairs_.drop(index); break;
    case alone: TW_ASSERT(false, "a pair was left to nobody");
  }
}

// After a rollback of one of its bodies to `key`: what was known from there on is forgotten.
void PairChecks::reset(std::uint32_t index, const Key& key) {
  Pair& pair = pairs_[index];
  if (pair.pending && pair.impact < key) return;
  pair.clearance.forget_from(key.time);
  forget_if_edited(pair, key);
  // (a state that is removed and found again may have the key that it had, and another arc: what
  // was checked of a piece that begins there, its touch included, is no longer so)
  if (pair.pending || key <= pair.from || pair.parked) {
    pair.from = pair.pending ? key : std::min(pair.from, key);
    pair.started = false;
  }
  pair.pending = false;
  pair.parked = false;
  const State& tail_a = tail_of(pair.a);
  const State& tail_b = tail_of(pair.b);
  const bool stopped = tail_a.error || tail_b.error;
  if (!stopped && (moves_in_group(tail_a) || moves_in_group(tail_b))) {
    // the next claim asks again
    sim_.queue.withdraw(pair.event);
    return;
  }
  const double when = pair.started ? std::min(key.time, pair.next_check) : pair.from.time;
  apply(index, check_at(pair, std::max(pair.from.time, when)));
}

// ---- along the pieces: an outcome ends it, none leads on ----

// On to what follows the piece, where that is known.
std::optional<PairOutcome> PairChecks::next_piece(Pair& pair, const Piece& piece) const {
  pair.from = piece.end;
  if (piece.end == last_key || piece.ends_naturally) return waits;
  pair.started = false;
  forget_if_edited(pair, piece.end);
  return std::nullopt;
}

std::optional<PairOutcome> PairChecks::follow_exact(Pair& pair, const Piece& piece,
                                                    PairCounts& counts) const {
  ++counts.predictions;
  const double impact_time = exact_impact(piece);
  if (impact_time < never) {
    const Key key = pieces_.impact_key(piece, impact_time);
    if (key < piece.end) return pending_at(pair, key);
  }
  if (piece.end == last_key) return PairOutcome{PairOutcome::Kind::drop, {}};
  pair.from = piece.end;
  pair.started = false;
  return std::nullopt;
}

// ---- pairs on the grid ----

// Overlapping and approaching at the common start is an impact now; so is touch without either
// where something presses the two together, or one is in a group and the other is fixed or moves
// as it is told: the group's next check would find them in contact, and until then they would be
// looked at without end.  True if one was found.
bool PairChecks::check_common_start(Pair& pair, const Piece& piece, const SeenApart& seen,
                                    PairCounts& counts) const {
  const double start = piece.start_time();
  ++counts.checks;
  const double clear = certificate(piece, pair.caches, start, 0, &seen);
  counts.certificates += clear > -never;
  pair.next_check = std::max(grid_floor(clear), grid_after(start));
  if (clear > start) return false;
  const Separation s = separation_at(piece, start);
  if (s.distance > 0) return false;
  const double closing = closing_at(piece, start, s);
  const auto is_found = [](const State& state, const Body& other) {
    return moves_in_group(state) && !other.dynamic();
  };
  const bool held = pressed_at(piece, start, s.normal) || is_found(*piece.a, *piece.body_b) ||
                    is_found(*piece.b, *piece.body_a);
  if (closing < 0 || (closing == 0 && !held)) return false;
  pair.impact = pieces_.impact_key(piece, start);
  return true;
}

// Looks at one grid point; true if there is an impact at or before it (then pair.impact).
bool PairChecks::check_grid_point(Pair& pair, const Piece& piece, double when,
                                  PairCounts& counts) const {
  ++counts.checks;
  if (++pair.looks > counts.dearest_pair_checks) {
    counts.dearest_pair_checks = pair.looks;
    counts.dearest_pair[0] = pair.a;
    counts.dearest_pair[1] = pair.b;
  }
  Certificates certificates(piece, pair.caches, when);
  double clear = certificates.until(slack_of(sim_.scene, piece));
  if (!(clear > when)) clear = certificates.until(depth_at_touch(sim_.scene, pair, piece));
  counts.certificates += clear > -never;
  pair.next_check = std::max(grid_floor(clear), when + answer::check_grid);
  if (clear > when) return false;

  // certainly at touch, perhaps overlapping: the cold distance decides
  const std::optional<double> known = certificates.overlap();
  return find_crossing(pair, piece, std::max(piece.start_time(), when - answer::check_grid), when,
                       known ? *known : distance_at(piece, when));
}

// The crossing of 0 or, where the left end touches already, of the depth at touch, where the two
// are deeper at `when`, where their distance is `right`; true if they are.  What gets deeper
// approaches somewhere, whatever the velocity at the witness points: drums side by side may part in
// the middle and tilt into each other at an end.
bool PairChecks::find_crossing(Pair& pair, const Piece& piece, double start, double when,
                               double right) const {
  if (right >= -slack_of(sim_.scene, piece)) return false;
  const double touch = depth_at_touch(sim_.scene, pair, piece);
  if (right >= -touch) return false;
  const double left = distance_at(piece, start);
  double impact_time = when;
  if (left > -touch) {
    const double level = left > 0 ? 0 : touch;
    const auto f = [&](double t) { return distance_at(piece, t) + level; };
    const double rounding = distance_rounding(*piece.body_a, piece.a->x, *piece.body_b, piece.b->x);
    impact_time = find_root(f, start, when, left + level, right + level, rounding).left;
  }
  pair.impact = pieces_.impact_key(piece, impact_time);
  return true;
}

// A dip before the next grid point; true if there is an impact (then pair.impact).
bool PairChecks::check_between(Pair& pair, const Piece& piece, double from,
                               PairCounts& counts) const {
  const double to = grid_after(from);
  if (pair.next_check != to) return false;
  const double dip = first_dip(piece, pair.caches, from, to, counts.certificates);
  return dip < never && find_crossing(pair, piece, from, dip, distance_at(piece, dip));
}

// After a free check at `checked`: no root is left before the bracket that the next check would
// open.
void PairChecks::raise_safe_time(Pair& pair, const Piece& piece, double checked) const {
  const double safe = std::max(checked, pair.next_check - answer::check_grid);
  if (pair.from.time < safe && safe < piece.end.time) pair.from = {safe, 0, KeyKind::birth, 0};
}

// What follows from the first impact of the two arcs: beyond the piece's end there is none on the
// piece.  To look on would be to find another root in another bracket, where the two touch for a
// while: that of a piece which was cut before it was looked at, and not of one that is cut later.
std::optional<PairOutcome> PairChecks::decided(Pair& pair, const Piece& piece) const {
  if (pair.impact < piece.end) return pending_at(pair, pair.impact);
  return next_piece(pair, piece);
}

// Follows a piece on the grid.
std::optional<PairOutcome> PairChecks::follow_on_grid(Pair& pair, const Piece& piece, double until,
                                                      const SeenApart& seen,
                                                      PairCounts& counts) const {
  if (!pair.started || pair.checked_start != piece.start) {
    pair.started = true;
    pair.checked_start = piece.start;
    pair.touch = 0;
    // an impact at the common start that was rolled back is found again from its own key on
    if (pair.from <= piece.start || pair.from.time == piece.start_time()) {
      if (check_common_start(pair, piece, seen, counts) ||
          check_between(pair, piece, piece.start_time(), counts))
        return decided(pair, piece);
      raise_safe_time(pair, piece, piece.start_time());
    } else {
      pair.next_check = grid_ceil(pair.from.time);
      if (pair.next_check <= piece.start_time()) pair.next_check = grid_after(piece.start_time());
      // taken up between two grid points: a dip belongs to the whole stretch between them
      const double before = std::max(piece.start_time(), grid_floor(pair.from.time));
      if (before < pair.next_check && check_between(pair, piece, before, counts))
        return decided(pair, piece);
    }
  }

  // grid points up to the first at or after the piece's end
  const double last = grid_ceil(piece.end.time);
  while (pair.next_check <= last && pair.next_check < never) {
    const double when = pair.next_check;
    if (when > until && piece.end.time > until) {
      // a root could lie in the step before the next check, not earlier
      const double safe = std::min(when - answer::check_grid, piece.end.time);
      if (safe > pair.from.time) pair.from = {safe, 0, KeyKind::birth, 0};
      if (moves_in_group(*piece.a) || moves_in_group(*piece.b)) return waits;
      return check_at(pair, std::min(when, piece.end.time));
    }
    if (check_grid_point(pair, piece, when, counts) || check_between(pair, piece, when, counts))
      return decided(pair, piece);
    raise_safe_time(pair, piece, when);
  }
  // apart for ever: wait until the arcs change or the boxes part
  return next_piece(pair, piece);
}

// Over as many pieces as it takes, up to the event's time.
PairOutcome PairChecks::follow(Pair& pair, PairCounts& counts, bool as_helper,
                               const Travels& travels) const {
  const double now =
      pair.event == EventQueue::none ? pair.from.time : sim_.queue.event(pair.event).key.time;
  for (;;) {
    const Piece piece = pieces_.at(pair.a, pair.b, pair.from);
    if (piece.a->error || piece.b->error) {
      pair.parked = true;
      return waits;
    }
    if (in_contact(piece)) {
      if (const auto end = next_piece(pair, piece)) return *end;
      continue;
    }
    if (as_helper && (Horizon::is_open(*piece.a) || Horizon::is_open(*piece.b)))
      return {PairOutcome::Kind::alone, {}};
    // arcs of moving groups are known as far as both have claimed
    double until = now;
    SeenApart seen;
    if (moves_in_group(*piece.a) || moves_in_group(*piece.b)) {
      until = std::min(sim_.process(sim_.body(pair.a)).claim.time,
                       sim_.process(sim_.body(pair.b)).claim.time);
      if (!(pair.from.time < until)) {
        // what an error stopped at this very instant claims no more
        const auto stopped = [&](const State& tail) {
          return tail.error && !(pair.from.time < tail.key.time);
        };
        pair.parked = stopped(tail_of(pair.a)) || stopped(tail_of(pair.b));
        return waits;
      }
      const double to = std::min(until, piece.end.time);
      if (apart_throughout(piece, pair.clearance, pair.caches, pair.from.time, to, travels,
                           &seen)) {
        if (to == piece.end.time) {
          if (const auto end = next_piece(pair, piece)) return *end;
          continue;
        }
        pair.from = {to, 0, KeyKind::birth, 0};
        pair.started = false;
        return waits;
      }
    }
    // what was replaced at the instant at which it began no claim has completed
    for (const State* state : {piece.a, piece.b})
      if (moves_in_group(*state)) state->group->arc->extend(state->group->arc->start().end);
    try {
      const auto end = predicted_exactly(piece) ? follow_exact(pair, piece, counts)
                                                : follow_on_grid(pair, piece, until, seen, counts);
      if (end) return *end;
    } catch (...) {
      // Ctrl-C: a dip that was looked for is looked for again, so all is from the safe time on
      pair.started = false;
      throw;
    }
  }
}

void PairChecks::pursue(std::uint32_t index) {
  apply(index, follow(pairs_[index], counters_, false, Travels()));
}

// ---- those that meet ----

// Whether the two have a record, or are to have one.
void PairChecks::look_up(Meeting& m) const {
  m.pair = pairs_.find(m.a, m.b);
  if (m.pair != ActivePairs::none) {
    const Pair& pair = pairs_[m.pair];
    const bool has_time = pair.event == EventQueue::none && !pair.pending && !pair.parked;
    m.outcome.kind =
        has_time && pair.from != last_key ? PairOutcome::Kind::wait : PairOutcome::Kind::nothing;
    return;
  }
  const Piece first = pieces_.at(std::min(m.a, m.b), std::max(m.a, m.b), m.from);
  if (pieces_.in_contact_from(first)) return;
  // an exact pair gets a record only when it will meet
  bool all_exact = true;
  const auto impact = pieces_.first_exact_impact(first, all_exact);
  m.is_new = impact || !all_exact;
  if (impact) m.outcome = {PairOutcome::Kind::schedule, *impact};
}

void PairChecks::meet(std::vector<Meeting>& meetings) {
  using enum PairOutcome::Kind;
  constexpr std::size_t grain = 16;
  const Travels travels;
  each_in_parallel(meetings.size(), grain, [&](std::size_t i) { look_up(meetings[i]); });
  for (Meeting& m : meetings)
    if (m.is_new) m.pair = make(m.a, m.b, m.from);
  each_in_parallel(meetings.size(), grain, [&](std::size_t i) {
    Meeting& m = meetings[i];
    if (m.outcome.kind == schedule)
      m.outcome = pending_at(pairs_[m.pair], m.outcome.key);
    else if (m.is_new || m.outcome.kind == wait)
      m.outcome = follow(pairs_[m.pair], m.counts, true, travels);
  });
  for (Meeting& m : meetings) {
    if (m.outcome.kind == alone) m.outcome = follow(pairs_[m.pair], m.counts, false, travels);
    counters_.add(m.counts);
    apply(m.pair, m.outcome);
  }
}

}  // namespace tw
