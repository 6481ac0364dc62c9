// How the arc of a group starts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/start-arc.h"

#include <algorithm>

#include "groups/regroup/start-members.h"
#include "integrate/standing.h"

namespace tw {
namespace {

// The motion of a body that a group meets.
TrajectoryPtr outside_motion(const Regrouping& work, BodyId id) {
  const Body& body = work.scene().body(id);
  if (!body.dynamic()) return body.motion;
  const Successor& successor = *work.successor_of(id);
  // laid to rest by this discontinuity, or, seen from there, what goes on: it is not asked for long
  if (work.changes(&successor)) return make_standing({successor.point.x, successor.point.q});
  const Group& theirs = *successor.data.group;
  if (theirs.at_rest) return successor.data.follows;
  // a copy of what the new group will see of it: a group that kept those at its border, and these
  // theirs, would keep all there ever were
  return theirs.arc->excerpt(static_cast<int>(successor.data.member), work.now(),
                             known_until(work, successor));
}

void start_members(const Regrouping& work, const Group& group, StartOfMembers& members) {
  for (const ProcessId member : group.members) {
    const Successor& successor = *work.successor_of(member);
    members.add(*successor.body, successor.point, successor.data, successor.joints);
  }
}

// The law of a contact that stands becomes another one: its offset, its stretch and its bend go
// along so that it presses and holds as it did.  For as long as two bodies are in contact their law
// gets stiffer alone, and a stiffer spring has less energy at the same force.
void change_law(NewContact& c, const ContactConstants& law) {
  GroupContact& contact = c.contact;
  contact.law = law;
  if (!c.law_before) return;
  const ContactConstants& was = *c.law_before;
  if (was.k == law.k && was.hardening == law.hardening) return;
  const double held = was.kt * friction_grip(was, contact.offset - c.gap);
  const double force = spring_force(was, contact.share, contact.offset - c.gap);
  if (force > 0) contact.offset = spring_depth(law, contact.share, force) + c.gap;
  if (!(law.kt > 0)) return;
  const double ratio = held / (law.kt * friction_grip(law, contact.offset - c.gap));
  contact.stretch *= ratio;
  contact.bend *= ratio;
}

// Springs and holds among the members, each once.
void start_bonds(const Regrouping& work, const Group& group, GroupStart& start) {
  const auto member = [&](BodyId id) { return group.member_of(work.scene().process_of(id)); };
  for (const ProcessId process : group.members) {
    const Successor& successor = *work.successor_of(process);
    for (const BondPtr& bond : bonds_of(successor.data.forces)) {
      if (bond->a != successor.body->id()) continue;
      start.bonds.push_back({member(bond->a), member(bond->b), bond});
      TW_ASSERT(start.bonds.back().b >= 0, "a bond goes out of its group");
    }
  }
}

// Contacts as a start has them: those of its members and of the outside bodies that they meet.
class StartOfContacts {
 public:
  StartOfContacts(const Regrouping& work, Group& group, GroupStart& start)
      : work_(work), group_(group), start_(start) {}

  // All of the group's pairs, renumbered.
  void add(const std::vector<NewContact>& all) {
    std::size_t count = 0;
    for (const ContactPair& pair : group_.pairs) count += pair.count;
    start_.contacts.reserve(count);
    group_.tags.reserve(count);
    group_.gaps.reserve(count);
    contacts_.reserve(count);
    for (ContactPair& pair : group_.pairs) add(all, pair);
    // also what is in contact without a point is looked at along the arc (end-test.h)
    for (const ContactPair& pair : group_.pairs)
      for (const BodyId id : {pair.a(), pair.b()}) index_of(id);
  }
  // As they look now.
  const std::vector<NewContact>& contacts() const { return contacts_; }

 private:
  void add(const std::vector<NewContact>& all, ContactPair& pair) {
    const Scene& scene = work_.scene();
    const std::uint32_t first = static_cast<std::uint32_t>(start_.contacts.size());
    pair.masses.add(group_.masses);
    const ContactConstants law =
        contact_scales(scene, scene.body(pair.a()), scene.body(pair.b()), pair.masses).law;
    each_contact(pair, [&](std::uint32_t c) {
      // a copy: two groups may hold the pair
      NewContact& contact = contacts_.emplace_back(all[c]);
      change_law(contact, law);
      // a damper holds against the push, too
      if (pushes(scene, contact.contact.offset))
        contact.contact.law.b = std::min(law.b, 0.5 / push_speed(scene, law.size));
      contact.contact.a = index_of(contact.tag.reference);
      contact.contact.b = index_of(contact.tag.other);
      start_.contacts.push_back(contact.contact);
      start_.contacts.back().pressed = contact.gap < contact.contact.offset;
      group_.tags.push_back(contact.tag);
      group_.gaps.push_back(contact.gap);
      pair.has_borne_load = pair.has_borne_load || contact.gap < contact.reach();
    });
    pair.first = first;
  }
  // >= 0: a member, else the complement of an outside body's number.
  int index_of(BodyId id) {
    const int member = group_.member_of(work_.scene().process_of(id));
    if (member >= 0) return member;
    const auto known = std::find(group_.outside.begin(), group_.outside.end(), id);
    if (known != group_.outside.end()) return ~static_cast<int>(known - group_.outside.begin());
    group_.outside.push_back(id);
    start_.outside.push_back(outside_motion(work_, id));
    return ~static_cast<int>(group_.outside.size() - 1);
  }

  const Regrouping& work_;
  Group& group_;
  GroupStart& start_;
  std::vector<NewContact> contacts_;
};

}  // namespace

// Until when one at a border knows where it goes, s.
double known_until(const Regrouping& work, const Successor& successor) {
  const Group& theirs = *successor.data.group;
  const double end = theirs.next_check_at(work.now());
  if (theirs.at_rest) return end;
  theirs.arc->extend_patiently(end);
  return std::min(end, theirs.arc->last());
}

PlacedLoads start_arc(const Regrouping& work, const Contacts& contacts, Group& group) {
  GroupStart start;
  start.time = work.now();
  start.end = group.planned.time;
  start.first_step = group.first_step;
  // joints alone see everything
  if (!group.pairs.empty()) start.most_steps = answer::most_arc_steps;
  StartOfMembers members(work.scene(), start);
  start_members(work, group, members);
  start_bonds(work, group, start);
  StartOfContacts touching(work, group, start);
  touching.add(contacts.all);
  members.set_tolerances();
  PlacedLoads loads;
  const std::vector<BodyId>& placed = work.placed_now.bodies;
  const auto holds_it = [&](BodyId id) { return group.contains(work.scene().process_of(id)); };
  if (work.placed_now.starts_loaded && std::any_of(placed.begin(), placed.end(), holds_it))
    loads = load_placed(work, start, touching.contacts());
  group.arc = std::make_shared<GroupArc>(std::move(start));
  return loads;
}

}  // namespace tw
