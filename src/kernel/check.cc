// Collision checks: the first impact of a pair, on the arcs that stand.
//
// A pair is followed piece by piece (a piece: both arcs stand).  On each piece the impact is a
// function of the two arcs' starts alone, as if they were never cut:
//   exact     spheres that fall alike, sphere and fixed plane: a quadratic (impact-time.h)
//   on grid   otherwise: at the common start, then at multiples of h = 2^-20 s.  A conservative
//             certificate skips grid points at which the pair is surely apart.  The impact lies
//             before the first grid point with penetration; Brent's method finds it on the signed
//             distance, cold.
// An impact found with key K is valid only if K is below the piece's end.  So it does not matter
// when, in which order or how often a pair is checked.
//
// Equality: at the common start, overlapping and approaching is an impact now, overlapping and
// separating is none.  A contact shorter than h that no grid point sees does not exist.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "detect/approach.h"
#include "detect/exact-impact.h"
#include "kernel/kernel.h"
#include "math/root.h"

namespace tw {
namespace {

// Depth that does not count as penetration, share of the smaller size: above the rounding of a
// distance query (3e-15) and of positions after many impacts, far below any accuracy asked for.
constexpr double depth_slack = 1e-12;

double grid_floor(double t) { return std::floor(t / check_grid) * check_grid; }
double grid_ceil(double t) { return std::ceil(t / check_grid) * check_grid; }
double grid_after(double t) { return (std::floor(t / check_grid) + 1) * check_grid; }

const State* next_arc(const State* state) {
  for (state = state->next; state && !state->starts_arc();) state = state->next;
  return state;
}

bool moves_in_group(const State& state) { return state.trajectory().stepped() && !state.error; }

Key key_or_last(const State* state) { return state ? state->key : last_key; }

}  // namespace

// ---- records ----

std::uint32_t Kernel::find_pair(const Body& a, const Body& b) const {
  const Body& shorter = a.pairs.size() <= b.pairs.size() ? a : b;
  const BodyId x = std::min(a.id(), b.id()), y = std::max(a.id(), b.id());
  for (const std::uint32_t index : shorter.pairs)
    if (pairs[index].a == x && pairs[index].b == y) return index;
  return no_pair;
}

std::uint32_t Kernel::make_pair(Body& a, Body& b, const Key& from) {
  std::uint32_t index;
  if (unused_pairs.empty()) {
    index = static_cast<std::uint32_t>(pairs.size());
    pairs.emplace_back();
  } else {
    index = unused_pairs.back();
    unused_pairs.pop_back();
  }
  Body& first = a.id() < b.id() ? a : b;
  Body& second = a.id() < b.id() ? b : a;
  Pair& pair = pairs[index];
  pair = Pair();
  pair.live = true;
  pair.a = first.id();
  pair.b = second.id();
  pair.from = from;
  pair.head_start = std::max(process(first).head_start, process(second).head_start);
  pair.place_a = static_cast<std::uint32_t>(first.pairs.size());
  pair.place_b = static_cast<std::uint32_t>(second.pairs.size());
  first.pairs.push_back(index);
  second.pairs.push_back(index);
  ++counters.pairs_made;
  ++counters.live_pairs;
  return index;
}

void Kernel::drop_pair(std::uint32_t index) {
  Pair& pair = pairs[index];
  queue.withdraw(pair.event);
  const auto take_out = [&](Body& body, std::uint32_t place) {
    const std::uint32_t moved = body.pairs.back();
    body.pairs[place] = moved;
    body.pairs.pop_back();
    if (moved == index) return;
    (pairs[moved].a == body.id() ? pairs[moved].place_a : pairs[moved].place_b) = place;
  };
  take_out(*bodies[pair.a], pair.place_a);
  take_out(*bodies[pair.b], pair.place_b);
  pair.live = false;
  pair.caches.clear();
  unused_pairs.push_back(index);
  --counters.live_pairs;
}

void Kernel::schedule_pair(std::uint32_t index, double when) {
  Pair& pair = pairs[index];
  const Key key{when, 0, KeyKind::step, pair_id(pair.a, pair.b)};
  queue.schedule(pair.event, make_event(key, EventKind::pair, index, pair.head_start));
}

void Kernel::set_pending(std::uint32_t index, const Key& key) {
  Pair& pair = pairs[index];
  pair.pending = true;
  pair.impact = key;
  queue.schedule(pair.event, make_event(key, EventKind::pair, index, pair.head_start));
}

// After a rollback of one of its bodies to `key`: what was known from there on is forgotten.
void Kernel::reset_pair(std::uint32_t index, const Key& key) {
  Pair& pair = pairs[index];
  if (pair.pending && pair.impact < key) return;
  pair.clearance.forget_from(key.time);
  if (pair.pending || key < pair.from || pair.parked) {
    pair.from = pair.pending ? key : std::min(pair.from, key);
    pair.started = false;
  }
  pair.pending = false;
  pair.parked = false;
  const State& tail_a = *graph.tail(process_of(pair.a));
  const State& tail_b = *graph.tail(process_of(pair.b));
  const bool stopped = tail_a.error || tail_b.error;
  if (!stopped && (moves_in_group(tail_a) || moves_in_group(tail_b))) {
    // the next claim asks again
    queue.withdraw(pair.event);
    return;
  }
  const double when = pair.started ? std::min(key.time, pair.next_check) : pair.from.time;
  schedule_pair(index, std::max(pair.from.time, when));
}

// ---- pieces ----

Piece Kernel::piece_at(BodyId a, BodyId b, const Key& from) const {
  Piece piece;
  piece.body_a = bodies[a].get();
  piece.body_b = bodies[b].get();
  piece.a = graph.last_at_or_before(process_of(a), from);
  piece.b = graph.last_at_or_before(process_of(b), from);
  if (!piece.a) piece.a = graph.head(process_of(a));
  if (!piece.b) piece.b = graph.head(process_of(b));
  piece.start = std::max(piece.a->arc_key, piece.b->arc_key);
  piece.end = std::min(key_or_last(next_arc(piece.a)), key_or_last(next_arc(piece.b)));
  const double natural = std::min(piece.a->trajectory().end(), piece.b->trajectory().end());
  if (natural < piece.end.time) {
    piece.end = {natural, 0, KeyKind::birth, 0};
    piece.ends_naturally = true;
  }
  return piece;
}

bool Kernel::in_contact(const Piece& piece) const {
  const Group* owner = owner_of(*piece.a, *piece.b);
  return owner && owner->find(pair_id(piece.body_a->id(), piece.body_b->id()));
}

// Whether the two are in contact from `from` on as far as is known.
bool Kernel::in_contact_from(BodyId a, BodyId b, const Key& from) const {
  for (Key at = from;;) {
    const Piece piece = piece_at(a, b, at);
    if (!in_contact(piece)) return false;
    if (piece.ends_naturally || piece.end == last_key) return true;
    at = piece.end;
  }
}

// On to what follows the piece; false if that is not known yet.
bool Kernel::next_piece(Pair& pair, const Piece& piece) {
  pair.from = piece.end;
  if (piece.end == last_key || piece.ends_naturally) {
    queue.withdraw(pair.event);
    return false;
  }
  pair.started = false;
  return true;
}

Key Kernel::impact_key(const Piece& piece, double impact_time) const {
  // the last states at or before the impact, records and slot changes included
  std::uint32_t microstep = 0;
  for (const State* state : {piece.a, piece.b}) {
    if (!body_of(state->process).dynamic()) continue;
    if (state->arc_key.time == impact_time)
      microstep = std::max(microstep, state->arc_key.microstep);
    for (const State* s = state; s && s->key < piece.end && s->key.time <= impact_time; s = s->next)
      if (s->key.time == impact_time && s->key.kind == KeyKind::edit)
        microstep = std::max(microstep, s->key.microstep);
  }
  return {impact_time, microstep + 1, KeyKind::impact,
          pair_id(piece.body_a->id(), piece.body_b->id())};
}

// ---- exact pairs ----

// Follows the pieces from `from` as long as they are exact.
std::optional<Key> Kernel::first_exact_impact(const Body& a, const Body& b, const Key& from,
                                              bool& all_exact) const {
  const Body& first = a.id() < b.id() ? a : b;
  const Body& second = a.id() < b.id() ? b : a;
  for (Key at = from;;) {
    const Piece piece = piece_at(first.id(), second.id(), at);
    all_exact = !piece.a->error && !piece.b->error && predicted_exactly(piece);
    if (!all_exact) return std::nullopt;
    const double impact_time = exact_impact(piece);
    if (impact_time < never) {
      const Key key = impact_key(piece, impact_time);
      if (key < piece.end) return key;
    }
    if (piece.end == last_key) return std::nullopt;
    at = piece.end;
  }
}

bool Kernel::pursue_exact(std::uint32_t index, const Piece& piece) {
  Pair& pair = pairs[index];
  ++counters.predictions;
  const double impact_time = exact_impact(piece);
  if (impact_time < never) {
    const Key key = impact_key(piece, impact_time);
    if (key < piece.end) {
      set_pending(index, key);
      return true;
    }
  }
  if (piece.end == last_key) {
    // nothing will happen on these arcs: the next claim asks again
    drop_pair(index);
    return true;
  }
  pair.from = piece.end;
  pair.started = false;
  return false;
}

// ---- pairs on the grid ----

// Overlapping and approaching at the common start is an impact now.  True if one was found.
bool Kernel::check_common_start(Pair& pair, const Piece& piece) {
  const double start = piece.start_time();
  ++counters.checks;
  const double clear = certificate(piece, pair.caches, start, 0);
  counters.certificates += clear > -never;
  pair.next_check = std::max(grid_floor(clear), grid_after(start));
  if (clear > start) return false;
  const Separation s = separation_at(piece, start);
  if (s.distance > 0) return false;
  const double closing = closing_at(piece, start, s);
  if (closing < 0 || (closing == 0 && !pressed_at(piece, s.normal))) return false;
  pair.impact = impact_key(piece, start);
  return true;
}

// Looks at one grid point; true if there is an impact at or before it (then pair.impact).
bool Kernel::check_grid_point(Pair& pair, const Piece& piece, double when) {
  const Body& a = *bodies[pair.a];
  const Body& b = *bodies[pair.b];
  const double slack = depth_slack * std::min(a.least_width, b.least_width);
  ++counters.checks;
  const double clear = certificate(piece, pair.caches, when, slack);
  counters.certificates += clear > -never;
  pair.next_check = std::max(grid_floor(clear), when + check_grid);
  if (clear > when) return false;

  // certainly at touch, perhaps overlapping: the cold distance decides
  const double right = separation_at(piece, when).distance;
  if (right >= -slack) return false;

  // the crossing, of 0 or, where the left end touches already, of the slack
  const double start = std::max(piece.start_time(), when - check_grid);
  const double left = separation_at(piece, start).distance;
  double impact_time = when;
  if (left > -slack) {
    const double level = left > 0 ? 0 : slack;
    const auto f = [&](double t) { return separation_at(piece, t).distance + level; };
    impact_time = find_root(f, start, when, left + level, right + level).left;
  }
  if (!approaching_at(piece, impact_time)) return false;
  pair.impact = impact_key(piece, impact_time);
  return true;
}

// After a free check at `checked`: no root is left before the bracket that the next check would
// open.
void Kernel::raise_safe_time(Pair& pair, const Piece& piece, double checked) const {
  const double safe = std::max(checked, pair.next_check - check_grid);
  if (pair.from.time < safe && safe < piece.end.time) pair.from = {safe, 0, KeyKind::birth, 0};
}

// Follows a piece on the grid; true when the pair waits for an event, false: on to the next piece.
bool Kernel::pursue_on_grid(std::uint32_t index, const Piece& piece, double until) {
  Pair& pair = pairs[index];
  if (!pair.started || pair.checked_start != piece.start) {
    pair.started = true;
    pair.checked_start = piece.start;
    // an impact at the common start that was rolled back is found again from its own key on
    if (pair.from <= piece.start || pair.from.time == piece.start_time()) {
      if (check_common_start(pair, piece) && pair.impact < piece.end) {
        set_pending(index, pair.impact);
        return true;
      }
      raise_safe_time(pair, piece, piece.start_time());
    } else {
      pair.next_check = grid_ceil(pair.from.time);
      if (pair.next_check <= piece.start_time()) pair.next_check = grid_after(piece.start_time());
    }
  }

  // grid points up to the first at or after the piece's end
  const double last = grid_ceil(piece.end.time);
  while (pair.next_check <= last && pair.next_check < never) {
    const double when = pair.next_check;
    if (when > until && piece.end.time > until) {
      // a root could lie in the step before the next check, not earlier
      const double safe = std::min(when - check_grid, piece.end.time);
      if (safe > pair.from.time) pair.from = {safe, 0, KeyKind::birth, 0};
      if (moves_in_group(*piece.a) || moves_in_group(*piece.b))
        queue.withdraw(pair.event);
      else
        schedule_pair(index, std::min(when, piece.end.time));
      return true;
    }
    if (check_grid_point(pair, piece, when) && pair.impact < piece.end) {
      set_pending(index, pair.impact);
      return true;
    }
    raise_safe_time(pair, piece, when);
  }
  // apart for ever: wait until the arcs change or the boxes part
  return !next_piece(pair, piece);
}

// Moves the safe time up as far as the event's time, over as many pieces as it takes.
void Kernel::pursue(std::uint32_t index) {
  const double now = pairs[index].event == EventQueue::none
                         ? pairs[index].from.time
                         : queue.event(pairs[index].event).key.time;
  for (;;) {
    Pair& pair = pairs[index];
    const Piece piece = piece_at(pair.a, pair.b, pair.from);
    if (piece.a->error || piece.b->error) {
      pair.parked = true;
      queue.withdraw(pair.event);
      return;
    }
    if (in_contact(piece)) {
      if (!next_piece(pair, piece)) return;
      continue;
    }
    // arcs of moving groups are known as far as both have claimed
    double until = now;
    if (moves_in_group(*piece.a) || moves_in_group(*piece.b)) {
      until = std::min(process(*bodies[pair.a]).claim.time, process(*bodies[pair.b]).claim.time);
      if (!(pair.from.time < until)) {
        queue.withdraw(pair.event);
        return;
      }
      const double to = std::min(until, piece.end.time);
      if (apart_throughout(piece, pair.clearance, pair.caches, pair.from.time, to)) {
        if (to == piece.end.time) {
          if (!next_piece(pair, piece)) return;
          continue;
        }
        pair.from = {to, 0, KeyKind::birth, 0};
        pair.started = false;
        queue.withdraw(pair.event);
        return;
      }
    }
    // what was replaced at the instant at which it began no claim has completed
    for (const State* state : {piece.a, piece.b})
      if (moves_in_group(*state)) state->group->arc->extend(state->group->arc->start().end);
    const bool exact = predicted_exactly(piece);
    if (exact ? pursue_exact(index, piece) : pursue_on_grid(index, piece, until)) return;
  }
}

}  // namespace tw
