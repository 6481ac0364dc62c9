// Looking things up in a regrouping.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regrouping.h"

#include <algorithm>

namespace tw {

Successor* Regrouping::successor_of(ProcessId process) const {
  const auto at =
      std::lower_bound(index_.begin(), index_.end(), std::pair{process, std::size_t{0}});
  return at != index_.end() && at->first == process ? &successors[at->second] : nullptr;
}

void Regrouping::update_index() {
  index_.clear();
  for (std::size_t i = 0; i < successors.size(); ++i)
    index_.push_back({successors[i].process(), i});
  std::sort(index_.begin(), index_.end());
}

const PairBefore* Regrouping::pair_before(std::uint64_t pair) const {
  const auto at =
      std::lower_bound(pairs_before.begin(), pairs_before.end(), pair,
                       [](const PairBefore& known, std::uint64_t id) { return known.id < id; });
  return at != pairs_before.end() && at->id == pair ? &*at : nullptr;
}

PlacedBody Regrouping::placed(BodyId body) const {
  const Successor* successor = successor_of(body);
  return successor ? tw::placed(*successor) : before.placed(body);
}

Quat Regrouping::attitude(BodyId body) const {
  const Successor* successor = successor_of(body);
  return successor ? successor->point.q : scene().body(body).motion->pose(now()).q;
}

Collision Regrouping::told_of(CollisionKind kind, const ContactPair& pair) const {
  Collision row;
  row.kind = kind;
  row.key = key();
  row.time = now();
  row.body1 = pair.a();
  row.body2 = pair.b();
  return row;
}

}  // namespace tw
