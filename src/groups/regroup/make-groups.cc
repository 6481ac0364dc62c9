// Making groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/make-groups.h"

#include <algorithm>
#include <numeric>

#include "groups/ends/foreseen.h"
#include "groups/ends/planned-end.h"
#include "groups/regroup/start-arc.h"
#include "integrate/arc/member-trajectory.h"
#include "integrate/standing.h"

namespace tw {
namespace {

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

// Its contact pairs, and until when those at its border know where they go, s.
double take_pairs(const Regrouping& work, const Contacts& contacts, Group& group) {
  const auto is_member = [&](BodyId id) { return group.contains(work.scene().process_of(id)); };
  double border_end = never;
  for (const ContactPair& pair : contacts.pairs) {
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
  if (!before || (!finds_contacts(work.cause()) && work.cause() != Cause::callback)) return 0;
  if (work.cause() == Cause::callback && is_jerked(work, group)) return 0;
  // an arc that began at this very instant need not have been integrated
  return before->arc->start().time < work.now() ? before->arc->next_step() : before->first_step;
}

// At rest from here on.
void stop(Successor& successor) {
  if (successor.joints) std::fill(successor.joints->u.begin(), successor.joints->u.end(), 0.0);
  successor.point.v = successor.point.w = successor.data.v = successor.data.L = Vec3::Zero();
}

// All but its arc.
std::shared_ptr<Group> make_group(const Regrouping& work, const Contacts& contacts,
                                  const Parts& parts, const std::vector<ProcessId>& members) {
  auto group = std::make_shared<Group>();
  group->key = work.key();
  group->members = members;
  const double border_end = take_pairs(work, contacts, *group);
  const Group* before = same_before(work, *group);
  if (before) group->doublings = doublings_of(work, contacts, parts, *group, *before);
  const auto place_of = [&](ProcessId member) { return work.place_of(work.successor_of(member)); };
  group->at_rest = parts.rests[place_of(members.front())];
  const EndPlan plan = plan_end({work, contacts, *group, before, border_end});
  group->planned = plan.end;
  group->patience = plan.patience;
  group->first_step = first_step_of(work, *group, before);
  for (const ProcessId member : members) {
    group->placed_at = std::max(group->placed_at, placed_at(work.before.state(member)));
    if (group->at_rest)
      stop(*work.successor_of(member));
    else
      group->stillness.push_back(parts.stillness[place_of(member)]);
  }
  return group;
}

}  // namespace

MadeGroups make_groups(const Regrouping& work, const Contacts& contacts, Parts& parts) {
  const std::size_t count = work.successors.size();
  // one group a part, its members ascending
  std::vector<std::vector<ProcessId>> members(count);
  for (const auto& [process, i] : work.index())
    if (parts.held[i]) members[parts.together.root(i)].push_back(process);
  MadeGroups made;
  made.of.resize(count);
  for (std::size_t root = 0; root < count; ++root) {
    if (members[root].empty()) continue;
    const std::shared_ptr<Group> group = make_group(work, contacts, parts, members[root]);
    PlacedLoads loads = start_arc(work, contacts, *group);
    made.all.push_back(made.of[root] = group);
    made.unloaded.insert(made.unloaded.end(), loads.unloaded.begin(), loads.unloaded.end());
    made.placed_energy += loads.energy;
  }
  std::sort(made.unloaded.begin(), made.unloaded.end());
  for (std::size_t i = 0; i < count; ++i) made.of[i] = made.of[parts.together.root(i)];
  return made;
}

void enter_groups(const Regrouping& work, const MadeGroups& made) {
  for (std::size_t i = 0; i < work.successors.size(); ++i) {
    Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    StateData& data = successor.data;
    const std::shared_ptr<Group>& group = data.group = made.of[i];
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
