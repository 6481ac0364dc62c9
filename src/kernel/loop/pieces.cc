// The pieces of a pair of bodies.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/pieces.h"

#include <algorithm>

#include "detect/exact-impact.h"
#include "groups/before.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

const State* next_arc(const State* state) {
  for (state = state->next; state && !state->starts_arc();) state = state->next;
  return state;
}

Key key_or_last(const State* state) { return state ? state->key : last_key; }

}  // namespace

Piece Pieces::at(BodyId a, BodyId b, const Key& from) const {
  Piece piece;
  piece.body_a = &scene_.body(a);
  piece.body_b = &scene_.body(b);
  piece.a = graph_.last_at_or_before(scene_.process_of(a), from);
  piece.b = graph_.last_at_or_before(scene_.process_of(b), from);
  if (!piece.a) piece.a = graph_.head(scene_.process_of(a));
  if (!piece.b) piece.b = graph_.head(scene_.process_of(b));
  piece.start = std::max(piece.a->arc_key, piece.b->arc_key);
  piece.end = std::min(key_or_last(next_arc(piece.a)), key_or_last(next_arc(piece.b)));
  const double natural = std::min(piece.a->arc_end(), piece.b->arc_end());
  if (natural < piece.end.time) {
    piece.end = {natural, 0, KeyKind::birth, 0};
    piece.ends_naturally = true;
  }
  return piece;
}

bool in_contact(const Piece& piece) {
  const Group* owner = owner_of(*piece.body_a, *piece.a, *piece.body_b, *piece.b).get();
  return owner && owner->find(pair_id(piece.body_a->id(), piece.body_b->id()));
}

bool Pieces::in_contact_from(Piece piece) const {
  for (;; piece = next(piece)) {
    if (!in_contact(piece)) return false;
    if (piece.ends_naturally || piece.end == last_key) return true;
  }
}

Key Pieces::impact_key(const Piece& piece, double impact_time) const {
  // the last states at or before the impact, records and slot changes included
  std::uint32_t microstep = 0;
  for (const State* state : {piece.a, piece.b}) {
    if (!scene_.body_of(state->process).dynamic()) continue;
    if (state->arc_key.time == impact_time)
      microstep = std::max(microstep, state->arc_key.microstep);
    for (const State* s = state; s && s->key < piece.end && s->key.time <= impact_time; s = s->next)
      if (s->key.time == impact_time && s->key.kind == KeyKind::edit)
        microstep = std::max(microstep, s->key.microstep);
  }
  return {impact_time, microstep + 1, KeyKind::impact,
          pair_id(piece.body_a->id(), piece.body_b->id())};
}

std::optional<Key> Pieces::first_exact_impact(Piece piece, bool& all_exact) const {
  for (;; piece = next(piece)) {
    all_exact = !piece.a->error && !piece.b->error && predicted_exactly(piece);
    if (!all_exact) return std::nullopt;
    const double impact_time = exact_impact(piece);
    if (impact_time < never) {
      const Key key = impact_key(piece, impact_time);
      if (key < piece.end) return key;
    }
    if (piece.end == last_key) return std::nullopt;
  }
}

}  // namespace tw
