// Regrouping.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/regroup.h"

#include <algorithm>
#include <utility>

#include "groups/contacts/contact-graph.h"
#include "groups/contacts/share-stiffness.h"
#include "groups/joints/joints.h"
#include "groups/placed/placed-loads.h"
#include "groups/regroup/make-groups.h"
#include "groups/regroup/propagation.h"
#include "groups/told/changes.h"

namespace tw {
namespace {

// Arcs that were integrated to no end.
void count_discarded(const Groups& made, GroupCounters& counters) {
  for (const auto& group : made) {
    if (group->at_rest) continue;
    const GroupCounts counts = group->arc->counts();
    counters.integrations += counts.steps;
    counters.implicit_steps += counts.steps;
    counters.rejected_steps += counts.rejected;
    counters.factorizations += counts.factorizations;
    counters.force_evaluations += counts.evaluations;
    counters.integration_length += static_cast<double>(group->members.size()) *
                                   (group->arc->reached() - group->arc->start().time);
  }
}

void count_made(const Groups& made, GroupCounters& counters) {
  for (const auto& group : made) {
    ++counters.groups;
    counters.largest_group_bodies =
        std::max<std::uint64_t>(counters.largest_group_bodies, group->members.size());
    counters.largest_group_contacts =
        std::max<std::uint64_t>(counters.largest_group_contacts, group->tags.size());
  }
}

// The successors of a region: those given as they are, but with new arcs for all inside; then the
// others.
std::vector<Successor> successors_of(const Region& region, const Before& before,
                                     const std::vector<Successor>& given) {
  std::vector<Successor> all = given;
  all.reserve(given.size() + region.inside.size() + region.border.size());
  // of a heap all are given
  std::vector<std::pair<ProcessId, std::size_t>> places;
  for (std::size_t i = 0; i < given.size(); ++i) places.emplace_back(given[i].process(), i);
  std::sort(places.begin(), places.end());
  const auto known = [&](ProcessId process) {
    const auto at =
        std::lower_bound(places.begin(), places.end(), std::pair(process, std::size_t{0}));
    return at != places.end() && at->first == process ? &all[at->second] : nullptr;
  };
  const auto add_record = [&](ProcessId process, Role role) {
    all.push_back(make_successor(before, process, false));
    all.back().data.changed = false;
    all.back().role = role;
  };
  for (const ProcessId process : region.inside) {
    Successor* successor = known(process);
    if (!successor)
      all.push_back(make_successor(before, process, true));
    else if (!successor->starts_arc())
      start_new_arc(*successor, before.key());
  }
  for (const ProcessId process : region.border)
    if (!known(process)) add_record(process, Role::border);
  share_joints(all);
  follow_changed_joints(before.key().time, all);
  return all;
}

bool all_known(const Region& region, const Known& known) {
  return std::all_of(region.inside.begin(), region.inside.end(), known) &&
         std::all_of(region.border.begin(), region.border.end(), known);
}

// What one round comes to: successors with their groups, or who must be taken in.
struct Round {
  std::vector<ProcessId> more;          // beyond the region, who would notice
  std::vector<std::uint64_t> unloaded;  // pairs that are to be left out (placed-loads.h)
  Groups made;
  Told told;
};

Round go_round(const Regrouping& work, const std::vector<ProcessId>& struck,
               std::uint64_t& manifolds) {
  Round round;
  Contacts contacts = find_contacts(work, struck);
  manifolds += contacts.manifolds;
  round.told = contacts.told;
  // impulses that reach the border come first: then nothing is as it should be
  if (passes_impulses(work.cause())) {
    PassedOn passed = pass_on_impulses(work, contacts);
    if (round.more = std::move(passed.at_border); !round.more.empty()) return round;
    round.told.tally.add(passed.tally);
    contacts.part(passed.parted);
  }
  settle_joints(work);
  contacts.sort();
  share_stiffness(work.scene(), contacts);
  Parts parts = parts_of(work, contacts);
  MadeGroups made = make_groups(work, contacts, parts);
  round.unloaded = std::move(made.unloaded);
  if (!round.unloaded.empty()) return round;
  round.told.tally.placed_energy += made.placed_energy;
  round.told.add(tell_changes(work, contacts, parts));
  enter_groups(work, made);
  Noticed noticed = who_notices(work, contacts, made.all);
  round.told.tally.momentum_dropped += noticed.momentum_dropped;
  round.more = std::move(noticed.by);
  round.made = std::move(made.all);
  return round;
}

}  // namespace

bool touches_groups(const std::vector<Successor>& successors) {
  return std::any_of(successors.begin(), successors.end(), [](const Successor& successor) {
    return successor.starts_arc() && (successor.data.group || needs_group(successor.data.forces));
  });
}

Successor make_successor(const Before& before, ProcessId process, bool new_arc) {
  const State& state = before.state(process);
  Successor successor;
  successor.body = &before.scene().body_of(process);
  successor.point = state.trajectory().at(before.key().time);
  successor.data = state;
  successor.data.changed = true;
  successor.data.next_callback = never;
  successor.data.report.reset();
  successor.data.tally = {};
  successor.data.error = nullptr;
  if (state.joints) successor.joints = joints_at(state, before.key().time);
  const bool keeps_states = successor.body->dynamic() || successor.data.slots;
  successor.role = keeps_states ? Role::record : Role::no_state;
  if (new_arc) start_new_arc(successor, before.key());
  return successor;
}

std::variant<Regrouped, Waits> regroup(const Before& before, const Surroundings& surroundings,
                                       const Known& known, const RegroupRequest& request,
                                       const std::vector<Successor>& given,
                                       GroupCounters& counters) {
  std::vector<ProcessId> struck;
  for (const Successor& successor : given)
    if (successor.starts_arc()) insert(struck, successor.process());

  // the work list: the region grows until nobody beyond it would notice
  PlacedNow placed;
  if (request.cause == Cause::fusion && are_placed(before, struck)) {
    placed.bodies = placed_with(before, struck, request.together);
    for (const BodyId id : placed.bodies) insert(struck, before.scene().process_of(id));
  }
  Region region = region_of(before, struck, request.cause == Cause::edit || !placed.bodies.empty());
  for (;;) {
    if (!all_known(region, known)) return Waits{region};
    std::vector<Successor> successors = successors_of(region, before, given);
    placed.starts_loaded = !placed.bodies.empty() && region.inside.size() <= answer::most_placed;
    const Regrouping work(before, surroundings, request, placed, successors);
    const Round round = go_round(work, struck, counters.manifolds);
    if (!round.unloaded.empty()) {
      placed.left_out.insert(placed.left_out.end(), round.unloaded.begin(), round.unloaded.end());
      std::sort(placed.left_out.begin(), placed.left_out.end());
    } else if (round.more.empty()) {
      count_made(round.made, counters);
      put_on_first(successors, round.told);
      return Regrouped{std::move(successors)};
    } else {
      count_discarded(round.made, counters);
      widen(region, before, round.more);
    }
  }
}

}  // namespace tw
