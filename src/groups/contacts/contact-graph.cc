// The contact graph: finding contacts and carrying them along.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/contacts/contact-graph.h"

#include <algorithm>
#include <deque>

#include "base/parallel.h"
#include "groups/contacts/pair-look.h"
#include "groups/ends/check-times.h"

namespace tw {
namespace {

// The pair and its contacts as they stand, stretches evaluated at the discontinuity.
void carry(const Regrouping& work, const PairBefore& old, Contacts& contacts) {
  const ContactPair& pair = *old.pair;
  const Group& group = *old.owner;
  const double now = group.contact_time(work.now());
  for (const BodyId side : {pair.a(), pair.b()})
    if (const Successor* successor = work.successor_of(side); successor && successor->placed)
      return;
  // between runs somebody may have set them anew
  const Scene& scene = work.scene();
  if (is_edit(work.key()) && !scene.may_collide(scene.body(pair.a()), scene.body(pair.b()))) return;
  contacts.pairs.push_back({pair.id, static_cast<std::uint32_t>(contacts.all.size()), pair.count,
                            pair.has_borne_load, pair.masses});
  each_contact(pair, [&](std::uint32_t c) {
    const ContactForce f = group.arc->lone_contact_force(static_cast<int>(c), now);
    const GroupContact& known = group.arc->start().contacts[c];
    NewContact contact{known, group.tags[c], f.gap, f.normal, f.point, known.law};
    contact.share_before = known.share;
    // the side on which the other one is: what it was may have turned away with the body
    if (known.feature != ContactFeature::plane)
      contact.contact.normal = work.attitude(group.tags[c].reference).conjugate() * f.normal;
    contact.contact.stretch = group.arc->stretch(static_cast<int>(c), now);
    contact.contact.bend = group.arc->bend(static_cast<int>(c), now);
    contacts.all.push_back(contact);
  });
}

// Adds what was found of two.
void take(const Regrouping& work, const PairToLook& two, Look look, Contacts& contacts) {
  contacts.manifolds += look.manifolds;
  if (look.found == Look::Found::as_before)
    carry(work, *work.pair_before(pair_id(two.a->body->id(), two.b->body->id())), contacts);
  if (look.found != Look::Found::contact) return;
  look.pair.first = static_cast<std::uint32_t>(contacts.all.size());
  contacts.all.insert(contacts.all.end(), look.contacts.begin(), look.contacts.end());
  contacts.pairs.push_back(look.pair);
}

// Who was in contact with whom, from either side; ascending.
using Partners = std::vector<std::pair<BodyId, BodyId>>;

Partners partners_before(const Regrouping& work) {
  Partners partners;
  partners.reserve(2 * work.pairs_before.size());
  for (const PairBefore& old : work.pairs_before) {
    partners.push_back({old.pair->a(), old.pair->b()});
    partners.push_back({old.pair->b(), old.pair->a()});
  }
  std::sort(partners.begin(), partners.end());
  return partners;
}

// Whom a body touches or may have come to touch; ascending.  Boxes hold whoever is as near as a new
// contact is looked for (what is in them beyond that hangs on the claims, and is found apart); an
// old one may reach farther, as a cushion's does that was pressed deep: it is looked at anyhow.
std::vector<BodyId> candidates_of(const Regrouping& work, const Body& body,
                                  const std::vector<ProcessId>& looked_at,
                                  const Partners& partners) {
  const Scene& scene = work.scene();
  const bool may_disable = scene.may_disable();
  std::vector<BodyId> candidates;
  candidates.reserve(16);
  const auto consider = [&](BodyId other) {
    const Body& partner = scene.body(other);
    if (partner.dynamic()) {
      // once, from the body that was added first
      if (other < body.id() && holds(looked_at, partner.process)) return;
      // with others new contacts are found by collision checks
      const Successor* successor = work.successor_of(partner.process);
      if (!successor || (!work.changes(successor) && !work.pair_before(pair_id(body.id(), other))))
        return;
    }
    if (may_disable && !scene.may_collide(body, partner)) return;
    candidates.push_back(other);
  };
  work.surroundings.visit_near(body.id(), consider);
  for (auto at =
           std::lower_bound(partners.begin(), partners.end(), std::pair{body.id(), BodyId{0}});
       at != partners.end() && at->first == body.id(); ++at)
    consider(at->second);
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  return candidates;
}

// All contact pairs of some of the processes with new arcs, anew; those of the others as they
// stand. `looked_at`: ascending.
void refresh(const Regrouping& work, const std::vector<ProcessId>& looked_at, double interval,
             Contacts& contacts) {
  std::vector<Footing> footings;  // of each, as long as somebody looks
  footings.reserve(looked_at.size());
  const Partners partners = partners_before(work);
  std::vector<PairToLook> pairs;
  std::deque<PlacedBody> places;  // of those looked at together
  const bool together = Team::current();
  for (const ProcessId process : looked_at) {
    const PlacedBody here = placed(*work.successor_of(process));
    const Body& body = *here.body;
    if (!body.shape_P) continue;
    TW_ASSERT(body.dynamic(), body.info.name + " has a new arc and is not dynamic");
    const PlacedBody& mine = together ? places.emplace_back(here) : here;
    Footing& footing =
        footings.emplace_back(Footing{work.surroundings.ground_around(body, {mine.frame})});
    for (const BodyId other : candidates_of(work, body, looked_at, partners)) {
      const PlacedBody there = work.placed(other);
      const PlacedBody& theirs = together ? places.emplace_back(there) : there;
      const bool straight = body.id() < other;
      footing.meet(work, body, *theirs.body);
      const PairToLook two{straight ? &mine : &theirs, straight ? &theirs : &mine, &footing};
      if (together)
        pairs.push_back(two);
      else
        take(work, two, look_at(work, two, interval, LookFor::touching), contacts);
    }
  }
  constexpr std::size_t grain = 8;
  std::vector<Look> looks(pairs.size());
  each_in_parallel(looks.size(), grain, [&](std::size_t i) {
    looks[i] = look_at(work, pairs[i], interval, LookFor::touching);
  });
  for (std::size_t i = 0; i < looks.size(); ++i)
    take(work, pairs[i], std::move(looks[i]), contacts);
  const auto was_looked_at = [&](BodyId id) {
    return holds(looked_at, work.scene().process_of(id));
  };
  for (const PairBefore& old : work.pairs_before)
    if (!was_looked_at(old.pair->a()) && !was_looked_at(old.pair->b())) carry(work, old, contacts);
}

// What observers hear of a pair that came to touch together with others.
Collision fusion_of(const Regrouping& work, const ContactPair& pair, const Contacts& contacts) {
  Collision row = work.told_of(CollisionKind::fusion, pair);
  if (pair.count == 0) return row;
  const NewContact& first = contacts.all[pair.first];
  row.point = first.point;
  row.normal = first.tag.reference == row.body1 ? first.normal : Vec3(-first.normal);
  const Vec3 closing = work.placed(row.body1).velocity_at(first.point) -
                       work.placed(row.body2).velocity_at(first.point);
  row.speed = std::max(0.0, closing.dot(row.normal));
  return row;
}

// The two come to touch: looks at them, and tells of it where `is_told`.
void meet(const Regrouping& work, const PlacedBody& a, const PlacedBody& b, double interval,
          LookFor what, bool is_told, Contacts& contacts) {
  const PlacedBody& mover = a.body->dynamic() ? a : b;
  Footing footing{work.surroundings.ground_around(*mover.body, {mover.frame})};
  footing.meet(work, *mover.body, *(&mover == &a ? b : a).body);
  const PairToLook two{&a, &b, &footing};
  Look look = look_at(work, two, interval, what);
  const bool touches = look.found == Look::Found::contact;
  take(work, two, std::move(look), contacts);
  if (!touches) return;
  ++contacts.told.tally.fusions;
  if (is_told && work.request.reports_fusions)
    contacts.told.report.push_back(fusion_of(work, contacts.pairs.back(), contacts));
}

// The first two successors come to touch: they are in contact whatever their manifold says.  So are
// all pairs placed together with them that do touch, and hardly part or close.
void fuse(const Regrouping& work, double interval, Contacts& contacts) {
  const PlacedBody first = placed(work.successors[0]), second = placed(work.successors[1]);
  // who strikes each other is told by the impact
  meet(work, first, second, interval, LookFor::always, is_edit(work.key()), contacts);
  const PlacedTogether* together = work.request.together;
  if (!together) return;

  const Scene& scene = work.scene();
  const std::uint64_t struck = pair_id(first.body->id(), second.body->id());
  const std::vector<std::uint64_t>& left_out = work.placed_now.left_out;
  for (const BodyId id : work.placed_now.bodies)
    together->visit_touching(id, [&](BodyId other) {
      const Body& partner = scene.body(other);
      const std::uint64_t pair = pair_id(id, other);
      if ((partner.dynamic() && other < id) || pair == struck || work.pair_before(pair) ||
          !scene.may_collide(scene.body(id), partner) ||
          std::binary_search(left_out.begin(), left_out.end(), pair))
        return;
      meet(work, work.placed(std::min(id, other)), work.placed(std::max(id, other)), interval,
           LookFor::new_touch, true, contacts);
    });
}

}  // namespace

Contacts find_contacts(const Regrouping& work, const std::vector<ProcessId>& struck) {
  Contacts contacts;
  if (finds_contacts(work.cause()))
    refresh(work, struck, check_interval(work, struck), contacts);
  else
    for (const PairBefore& old : work.pairs_before) carry(work, old, contacts);
  if (work.cause() == Cause::fusion) fuse(work, check_interval(work, struck), contacts);
  return contacts;
}

}  // namespace tw
