// Cutting a regrouping into groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/make-groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "groups/changes.h"
#include "groups/components.h"
#include "groups/foreseen.h"
#include "groups/joined.h"
#include "groups/joints.h"
#include "groups/placed-loads.h"
#include "groups/planned-end.h"
#include "groups/rest.h"
#include "groups/share-stiffness.h"
#include "groups/start-members.h"
#include "integrate/member-trajectory.h"
#include "integrate/standing.h"
#include "multibody/multibody.h"

namespace tw {
namespace {

// At rest from here on.
void stop(Successor& successor) {
  if (successor.joints) std::fill(successor.joints->u.begin(), successor.joints->u.end(), 0.0);
  successor.point.v = successor.point.w = successor.data.v = successor.data.L = Vec3::Zero();
}

void index_pairs(const Scene& scene, Group& group) {
  const auto each_side = [&](auto&& visit) {
    for (std::uint32_t i = 0; i < group.pairs.size(); ++i)
      for (const BodyId id : {group.pairs[i].a(), group.pairs[i].b()})
        if (const int member = group.member_of(scene.process_of(id)); member >= 0)
          visit(static_cast<std::size_t>(member), i);
  };
  std::vector<std::uint32_t>& starts = group.pair_starts;
  starts.assign(group.members.size() + 1, 0);
  each_side([&](std::size_t member, std::uint32_t) { ++starts[member + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  group.pairs_by_member.resize(starts.back());
  std::vector<std::uint32_t> next = starts;
  each_side(
      [&](std::size_t member, std::uint32_t i) { group.pairs_by_member[next[member]++] = i; });
}

// Until when one at a border knows where it goes, s.
double known_until(const Regrouping& work, const Successor& successor) {
  const Group& theirs = *successor.data.group;
  const double end = theirs.next_check_at(work.now());
  if (theirs.at_rest) return end;
  theirs.arc->extend_patiently(end);
  return std::min(end, theirs.arc->last());
}

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

// Members, outside bodies, contacts and bonds as the integrator wants them.
void start_arc(Regrouping& work, Group& group) {
  GroupStart start;
  start.time = work.now();
  start.end = group.planned.time;
  start.first_step = group.first_step;
  // joints alone see everything
  if (!group.pairs.empty()) start.most_steps = answer::most_arc_steps;
  StartOfMembers members(work.scene(), start);
  start_members(work, group, members);
  start_bonds(work, group, start);

  // >= 0: a member, else the complement of an outside body's number
  const auto index_of = [&](BodyId id) {
    if (const int member = group.member_of(work.scene().process_of(id)); member >= 0) return member;
    const auto known = std::find(group.outside.begin(), group.outside.end(), id);
    if (known != group.outside.end()) return ~static_cast<int>(known - group.outside.begin());
    group.outside.push_back(id);
    start.outside.push_back(outside_motion(work, id));
    return ~static_cast<int>(group.outside.size() - 1);
  };
  std::size_t count = 0;
  for (const ContactPair& pair : group.pairs) count += pair.count;
  start.contacts.reserve(count);
  group.tags.reserve(count);
  group.gaps.reserve(count);
  std::vector<NewContact> contacts;
  contacts.reserve(count);
  for (ContactPair& pair : group.pairs) {
    const std::uint32_t first = static_cast<std::uint32_t>(start.contacts.size());
    pair.masses.add(group.masses);
    const ContactConstants law = contact_scales(work.scene(), work.scene().body(pair.a()),
                                                work.scene().body(pair.b()), pair.masses)
                                     .law;
    each_contact(pair, [&](std::uint32_t c) {
      // a copy: two groups may hold the pair
      NewContact& contact = contacts.emplace_back(work.contacts[c]);
      change_law(contact, law);
      // a damper holds against the push, too
      if (pushes(work.scene(), contact.contact.offset))
        contact.contact.law.b = std::min(law.b, 0.5 / push_speed(work.scene(), law.size));
      contact.contact.a = index_of(contact.tag.reference);
      contact.contact.b = index_of(contact.tag.other);
      start.contacts.push_back(contact.contact);
      start.contacts.back().pressed = contact.gap < contact.contact.offset;
      group.tags.push_back(contact.tag);
      group.gaps.push_back(contact.gap);
      pair.has_borne_load = pair.has_borne_load || contact.gap < contact.reach();
    });
    pair.first = first;
  }
  // also what is in contact without a point is looked at along the arc (end-test.h)
  for (const ContactPair& pair : group.pairs)
    for (const BodyId id : {pair.a(), pair.b()}) index_of(id);
  members.set_tolerances();
  const auto holds_it = [&](BodyId id) { return group.contains(work.scene().process_of(id)); };
  if (work.starts_loaded &&
      std::any_of(work.placed_bodies.begin(), work.placed_bodies.end(), holds_it))
    load_placed(work, start, contacts);
  group.arc = std::make_shared<GroupArc>(std::move(start));
}

// Its contact pairs, and until when those at its border know where they go, s.
double take_pairs(const Regrouping& work, Group& group) {
  const auto is_member = [&](BodyId id) { return group.contains(work.scene().process_of(id)); };
  double border_end = never;
  for (const ContactPair& pair : work.pairs) {
    const bool has_a = is_member(pair.a());
    if (!has_a && !is_member(pair.b())) continue;
    group.pairs.push_back(pair);
    const BodyId other = has_a ? pair.b() : pair.a();
    if (!work.scene().body(other).dynamic() || is_member(other)) continue;
    const Successor* successor = work.successor_of(other);
    if (!successor) continue;
    group.has_border = true;
    if (!work.changes(successor)) border_end = std::min(border_end, known_until(work, *successor));
  }
  index_pairs(work.scene(), group);
  for (const ProcessId member : group.members)
    group.masses.add(work.successor_of(member)->body->mass);
  if (group.has_border) group.masses = work.masses;
  return border_end;
}

// The group with these very members that was there before; null: there was none.
const Group* same_before(const Regrouping& work, const Group& group) {
  const auto same = std::find_if(work.old.begin(), work.old.end(),
                                 [&](const auto& old) { return old->members == group.members; });
  return same != work.old.end() ? same->get() : nullptr;
}

// Springs and holds to whatever it is.
std::vector<const Bond*> ties_of(const ForcesPtr& forces) {
  std::vector<const Bond*> ties;
  for (const BondPtr& bond : bonds_of(forces)) ties.push_back(bond.get());
  if (forces)
    for (const ForceLawPtr& law : forces->laws())
      if (law->bond()) ties.push_back(law->bond());
  return ties;
}

// Whether a callback set a velocity or tied two: what is stiff gives way to that within a small
// part of a step, and steps that pass over it end right but are wrong in their middles.
bool is_jerked(const Regrouping& work, const Group& group) {
  return std::any_of(group.members.begin(), group.members.end(), [&](ProcessId member) {
    const Successor& successor = *work.successor_of(member);
    const State& was = work.before.state(member);
    const PoseTwist before = was.trajectory().at(work.now());
    return successor.point.v != before.v || successor.point.w != before.w ||
           (successor.data.forces != was.forces &&
            ties_of(successor.data.forces) != ties_of(was.forces));
  });
}

// The step to be tried first: that which the arc before would have gone on with, if the same bodies
// go on much as they did.
double first_step_of(const Regrouping& work, const Group& group, const Group* before) {
  if (!before || (!finds_contacts(work.cause) && work.cause != Cause::callback)) return 0;
  if (work.cause == Cause::callback && is_jerked(work, group)) return 0;
  // an arc that began at this very instant need not have been integrated
  return before->arc->start().time < work.now() ? before->arc->next_step() : before->first_step;
}

void lay_to_rest(const Regrouping& work, Group& group) {
  group.at_rest = true;
  for (const ProcessId member : group.members) stop(*work.successor_of(member));
}

std::shared_ptr<Group> make_group(Regrouping& work, const std::vector<ProcessId>& members) {
  auto group = std::make_shared<Group>();
  group->key = work.key();
  group->members = members;
  const double border_end = take_pairs(work, *group);
  const Group* before = same_before(work, *group);
  if (before) group->doublings = doublings_of(work, *group, *before);
  const auto place_of = [&](ProcessId member) { return work.place_of(work.successor_of(member)); };
  const bool rests = work.rests[place_of(members.front())];
  const EndPlan plan = plan_end({work, *group, before, rests, border_end});
  group->planned = plan.end;
  group->patience = plan.patience;
  for (const ProcessId member : members)
    group->placed_at = std::max(group->placed_at, placed_at(work.before.state(member)));

  group->first_step = first_step_of(work, *group, before);
  if (rests)
    lay_to_rest(work, *group);
  else
    for (const ProcessId member : members)
      group->stillness.push_back(work.stillness[place_of(member)]);
  start_arc(work, *group);
  return group;
}

// The successors with new arcs that hang together by contact pairs, those that rest apart from the
// others, or that are joined.
Components parts_of(const Regrouping& work) {
  Components parts(work.successors.size());
  for (const ContactPair& pair : work.pairs) {
    const Successor *a = work.successor_of(pair.a()), *b = work.successor_of(pair.b());
    if (!work.changes(a) || !work.changes(b)) continue;
    if (const std::size_t i = work.place_of(a), j = work.place_of(b);
        work.rests[i] == work.rests[j])
      parts.join(i, j);
  }
  visit_joined(work, [&](std::size_t i, std::size_t j) { parts.join(i, j); });
  return parts;
}

}  // namespace

void make_groups(Regrouping& work) {
  std::sort(work.pairs.begin(), work.pairs.end(),
            [](const ContactPair& x, const ContactPair& y) { return x.id < y.id; });
  share_stiffness(work);

  // who touches anything at all, who hangs together, and where that comes to rest in part
  const std::size_t count = work.successors.size();
  work.touching.assign(count, false);
  work.stillness.resize(count);
  for (const ContactPair& pair : work.pairs)
    for (const BodyId id : {pair.a(), pair.b()})
      if (const Successor* member = work.successor_of(id); work.changes(member))
        work.touching[work.place_of(member)] = true;
  std::vector<bool> held = work.touching;
  // what is joined never parts
  for (std::size_t i = 0; i < count; ++i)
    if (is_in_group(work.successors[i]) && work.changes(&work.successors[i])) held[i] = true;
  for (std::size_t i = 0; i < count; ++i)
    if (held[i]) work.stillness[i] = stillness_of(work, work.successors[i]);
  work.rests.assign(count, false);
  Components components = parts_of(work);
  if (work.cause == Cause::check) {
    work.rests = who_rests(work, components);
    components = parts_of(work);
  }
  count_fissions(work, held);

  // one group a component, its members ascending
  std::vector<std::vector<ProcessId>> members(count);
  for (const auto& [process, i] : work.index())
    if (held[i]) members[components.root(i)].push_back(process);
  std::vector<std::shared_ptr<Group>> made(count);
  for (std::size_t root = 0; root < count; ++root)
    if (!members[root].empty()) work.made.push_back(made[root] = make_group(work, members[root]));

  note_changes(work);
  for (std::size_t i = 0; i < count; ++i) {
    Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    StateData& data = successor.data;
    const std::shared_ptr<Group>& group = data.group = made[components.root(i)];
    data.member = 0;
    if (!group) continue;
    const int member = group->member_of(successor.process());
    data.member = static_cast<std::uint32_t>(member);
    if (successor.joints) data.joints = successor.joints;
    data.follows =
        group->at_rest ? make_resting({data.x, data.q}) : member_trajectory(group->arc, member);
  }
}

}  // namespace tw
