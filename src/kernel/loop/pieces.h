// The pieces of a pair of bodies as the states stand, and the key of an impact on one.
//
// A look at a graph that stays as it is: nothing is kept, nothing changes.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>

#include "detect/piece.h"
#include "dynamics/scene.h"
#include "timeline/state-graph.h"

namespace tw {

class Pieces {
 public:
  Pieces(const Scene& scene, const StateGraph& graph) : scene_(scene), graph_(graph) {}

  // That which holds at the key, a before b.
  Piece at(BodyId a, BodyId b, const Key& from) const;
  // Whether the two are in contact from that piece on as far as is known.
  bool in_contact_from(Piece piece) const;
  Key impact_key(const Piece& piece, double impact_time) const;
  // Follows the pieces from that one on as long as they are exact; `all_exact`: they are for ever.
  std::optional<Key> first_exact_impact(Piece piece, bool& all_exact) const;

 private:
  // That which follows: where it ends.
  Piece next(const Piece& piece) const {
    return at(piece.body_a->id(), piece.body_b->id(), piece.end);
  }

  const Scene& scene_;
  const StateGraph& graph_;
};

// Whether the two are in contact within one group on this piece.
bool in_contact(const Piece& piece);

}  // namespace tw
