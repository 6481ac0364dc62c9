// Looking things up in a regrouping.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regrouping.h"

#include <algorithm>
#include <bit>

namespace tw {

// Where the process stands, or the free slot where it would.
std::size_t Regrouping::slot_of(ProcessId process) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = (number(process) * std::size_t{0x9e3779b1} >> 7) & mask;
  while (slots_[at].place != none && slots_[at].process != process) at = (at + 1) & mask;
  return at;
}

Successor* Regrouping::successor_of(ProcessId process) const {
  const std::uint32_t place = slots_[slot_of(process)].place;
  return place != none ? &successors[place] : nullptr;
}

void Regrouping::update_index() {
  index_.clear();
  for (std::size_t i = 0; i < successors.size(); ++i)
    index_.push_back({successors[i].process(), i});
  std::sort(index_.begin(), index_.end());
  slots_.assign(std::bit_ceil(2 * successors.size() + 1), {});
  for (std::uint32_t i = 0; i < successors.size(); ++i)
    slots_[slot_of(successors[i].process())] = {successors[i].process(), i};
}

bool Regrouping::pushes_apart(const ContactPair& pair) const {
  bool any = false;
  each_contact(pair,
               [&](std::uint32_t c) { any = any || pushes(scene(), contacts[c].contact.offset); });
  return any;
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
