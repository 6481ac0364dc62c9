// What a regrouping changed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/changes.h"

#include <algorithm>

#include "groups/components.h"
#include "groups/squeezed.h"

namespace tw {
namespace {

// How many pieces the successors make by these pairs, and by the holds of a body as `forces_of` has
// them; what keeps its arc is one.
template <class Pairs, class ForcesOf>
std::size_t count_pieces(const Regrouping& work, const Pairs& pairs, ForcesOf&& forces_of) {
  const std::size_t rest = work.successors.size();
  Components components(rest + 1);
  const auto place = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    return work.changes(successor) ? work.place_of(successor) : rest;
  };
  const Scene& scene = work.scene();
  std::size_t joints = 0;
  for (const auto& pair : pairs) {
    const BodyId a = first_of(pair.id), b = second_of(pair.id);
    if (!scene.body(a).dynamic() || !scene.body(b).dynamic()) continue;
    joints += components.join(place(a), place(b));
  }
  for (const Successor& successor : work.successors) {
    if (!work.changes(&successor)) continue;
    for (const BondPtr& bond : bonds_of(forces_of(successor)))
      joints += components.join(place(bond->a), place(bond->b));
  }
  return rest + 1 - joints;
}

Collision fission_of(const Regrouping& work, const PairBefore& old) {
  const ContactPair& pair = *old.pair;
  Collision row = work.told_of(CollisionKind::fission, pair);
  if (pair.count > 0) {
    const ContactForce f = old.owner->lone_contact_at(pair.first, work.now());
    const bool straight = old.owner->tags[pair.first].reference == row.body1;
    row.point = f.point;
    row.normal = straight ? f.normal : Vec3(-f.normal);
  }
  return row;
}

}  // namespace

void count_fissions(Regrouping& work, const std::vector<bool>& held) {
  const std::size_t pieces_before =
      count_pieces(work, work.pairs_before, [&](const Successor& successor) -> const ForcesPtr& {
        return work.before.state(successor.process()).forces;
      });
  const std::size_t pieces = count_pieces(
      work, work.pairs,
      [](const Successor& successor) -> const ForcesPtr& { return successor.data.forces; });
  std::size_t parted = pieces > pieces_before ? pieces - pieces_before : 0;
  for (std::size_t i = 0; i < work.successors.size(); ++i) {
    const Successor& successor = work.successors[i];
    if (work.changes(&successor) && !held[i] && successor.data.group &&
        successor.data.group->members.size() == 1)
      ++parted;
  }
  work.tally.fissions = static_cast<std::uint16_t>(parted);
}

void note_changes(Regrouping& work) {
  note_squeezed(work);
  const auto is_squeezed = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    return successor && successor->data.squeezed_since < never;
  };
  for (const ContactPair& pair : work.pairs)
    if (!is_squeezed(pair.a()) && !is_squeezed(pair.b()))
      each_contact(pair, [&](std::uint32_t c) { work.tally.note_gap(work.contacts[c].gap); });
  bool changed = false;
  std::size_t lasting = 0;
  for (const PairBefore& old : work.pairs_before) {
    const auto at =
        std::lower_bound(work.pairs.begin(), work.pairs.end(), old.id,
                         [](const ContactPair& p, std::uint64_t id) { return p.id < id; });
    const bool stands = at != work.pairs.end() && at->id == old.id;
    if (stands) {
      ++lasting;
      changed = changed || at->count != old.pair->count;
    } else if (old.pair->has_borne_load && work.tally.fissions > 0 && work.reports_fissions) {
      work.report.push_back(fission_of(work, old));
    }
    changed = changed || !stands;
  }
  changed = changed || lasting != work.pairs.size();
  work.tally.contact_changes = changed;
}

void add_report(Regrouping& work) {
  const auto first = std::find_if(work.successors.begin(), work.successors.end(),
                                  [](const Successor& s) { return s.enters(); });
  if (first == work.successors.end()) return;
  first->data.tally.add(work.tally);
  if (work.report.empty()) return;
  Report all = first->data.report ? *first->data.report : Report();
  all.insert(all.end(), work.report.begin(), work.report.end());
  first->data.report = std::make_shared<const Report>(std::move(all));
}

}  // namespace tw
