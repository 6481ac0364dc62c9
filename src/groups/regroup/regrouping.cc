// What a discontinuity concerns, and what stood there before it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/regrouping.h"

#include <algorithm>
#include <bit>

namespace tw {

Regrouping::Regrouping(const Before& standing, const Surroundings& near,
                       const RegroupRequest& asked, const PlacedNow& now,
                       std::vector<Successor>& all)
    : before(standing), surroundings(near), request(asked), placed_now(now), successors(all) {
  index_successors();
  collect_groups();
  collect_pairs();
}

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

void Regrouping::index_successors() {
  for (std::size_t i = 0; i < successors.size(); ++i)
    index_.push_back({successors[i].process(), i});
  std::sort(index_.begin(), index_.end());
  slots_.assign(std::bit_ceil(2 * successors.size() + 1), {});
  for (std::uint32_t i = 0; i < successors.size(); ++i)
    slots_[slot_of(successors[i].process())] = {successors[i].process(), i};
}

void Regrouping::collect_groups() {
  Groups all;
  for (const auto& [process, i] : index_) {
    const Successor& successor = successors[i];
    if (!successor.body->dynamic()) continue;
    add_once(all, successor.data.group);
    if (!changes(&successor)) {
      has_border = has_border || successor.data.group;
      continue;
    }
    add_once(old, successor.data.group);
    masses.add(successor.body->mass);
  }
  if (has_border)
    for (const auto& group : all) masses.add(group->masses);
}

void Regrouping::collect_pairs() {
  for (const auto& [process, i] : index_) {
    const Successor& successor = successors[i];
    if (!changes(&successor) || !successor.data.group) continue;
    const Group& group = *successor.data.group;
    for (const std::uint32_t number : group.pairs_of(successor.data.member)) {
      const std::uint64_t id = group.pairs[number].id;
      const Before::Owned owned = before.owned(id);
      if (owned.pair) pairs_before.push_back({id, owned.owner, owned.pair});
    }
  }
  std::sort(pairs_before.begin(), pairs_before.end(),
            [](const PairBefore& x, const PairBefore& y) { return x.id < y.id; });
  // from either side
  const auto same = [](const PairBefore& x, const PairBefore& y) { return x.id == y.id; };
  pairs_before.erase(std::unique(pairs_before.begin(), pairs_before.end(), same),
                     pairs_before.end());
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
