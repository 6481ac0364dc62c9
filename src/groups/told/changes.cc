// What a regrouping changed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/told/changes.h"

#include <algorithm>

#include "groups/components.h"
#include "groups/told/squeezed.h"

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

// Bodies that came apart, and those that left the ground alone.
std::uint16_t fissions_of(const Regrouping& work, const Contacts& contacts, const Parts& parts) {
  const std::size_t pieces_before =
      count_pieces(work, work.pairs_before, [&](const Successor& successor) -> const ForcesPtr& {
        return work.before.state(successor.process()).forces;
      });
  const std::size_t pieces = count_pieces(
      work, contacts.pairs,
      [](const Successor& successor) -> const ForcesPtr& { return successor.data.forces; });
  std::size_t parted = pieces > pieces_before ? pieces - pieces_before : 0;
  for (std::size_t i = 0; i < work.successors.size(); ++i) {
    const Successor& successor = work.successors[i];
    if (work.changes(&successor) && !parts.held[i] && successor.data.group &&
        successor.data.group->members.size() == 1)
      ++parted;
  }
  return static_cast<std::uint16_t>(parted);
}

}  // namespace

Told tell_changes(const Regrouping& work, const Contacts& contacts, const Parts& parts) {
  Told told = note_squeezed(work, contacts);
  Tally& tally = told.tally;
  tally.fissions = fissions_of(work, contacts, parts);
  const auto is_squeezed = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    return successor && successor->data.squeezed_since < never;
  };
  for (const ContactPair& pair : contacts.pairs)
    if (!is_squeezed(pair.a()) && !is_squeezed(pair.b()))
      each_contact(pair, [&](std::uint32_t c) { tally.note_gap(contacts.all[c].gap); });
  bool changed = false;
  std::size_t lasting = 0;
  for (const PairBefore& old : work.pairs_before) {
    const ContactPair* stands = contacts.find(old.id);
    if (stands) {
      ++lasting;
      changed = changed || stands->count != old.pair->count;
    } else if (old.pair->has_borne_load && tally.fissions > 0 && work.request.reports_fissions) {
      told.report.push_back(fission_of(work, old));
    }
    changed = changed || !stands;
  }
  tally.contact_changes = changed || lasting != contacts.pairs.size();
  return told;
}

void put_on_first(std::vector<Successor>& successors, const Told& told) {
  const auto first = std::find_if(successors.begin(), successors.end(),
                                  [](const Successor& s) { return s.enters(); });
  if (first == successors.end()) return;
  first->data.tally.add(told.tally);
  if (told.report.empty()) return;
  Report all = first->data.report ? *first->data.report : Report();
  all.insert(all.end(), told.report.begin(), told.report.end());
  first->data.report = std::make_shared<const Report>(std::move(all));
}

}  // namespace tw
