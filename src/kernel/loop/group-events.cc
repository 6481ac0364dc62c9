// What the loop does for contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/group-events.h"

#include <algorithm>

#include "base/constants.h"
#include "groups/ends/check-times.h"
#include "groups/ends/end-test.h"
#include "groups/ends/group-check.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/delivery.h"

namespace tw {

GroupEvents::GroupEvents(Simulation& simulation, const Horizon& horizon, Claims& claims,
                         Discontinuities& discontinuities, const Delivery& delivery)
    : sim_(simulation),
      counters_(simulation.present.counters),
      horizon_(horizon),
      claims_(claims),
      discontinuities_(discontinuities),
      delivery_(delivery),
      ahead_(simulation, [this](Decision& decision) { return decide_ahead(decision); }) {}

bool GroupEvents::await(ProcessId id, const Key& key) {
  if (horizon_.is_known(id, key)) return true;
  const bool only_its_check = horizon_.is_claimed(id, key);
  while (!horizon_.is_claimed(id, key) &&
         sim_.process(sim_.body_of(id)).claim.time < sim_.graph.tail(id)->arc_end())
    claims_.claim_window(sim_.body_of(id));
  // the group check that stands before the key
  if (only_its_check || !horizon_.is_claimed(id, key)) static_cast<void>(check(id));
  return false;
}

bool GroupEvents::await(const Region& region, const Key& key) {
  bool all_known = true;
  for (const std::vector<ProcessId>* part : {&region.inside, &region.border})
    for (const ProcessId id : *part) all_known = await(id, key) && all_known;
  return all_known;
}

bool GroupEvents::await_struck(std::span<const BodyId> bodies, const Key& key) {
  bool all_known = true;
  for (const BodyId id : bodies) all_known = await(sim_.process_of(id), key) && all_known;
  return all_known && await(region_struck(bodies, sim_.before(key)), key);
}

// Of all that a discontinuity of these bodies may concern; who is in no group concerns nobody else.
Region GroupEvents::region_struck(std::span<const BodyId> bodies, const Before& before) const {
  std::vector<ProcessId> members;
  for (const BodyId id : bodies)
    if (sim_.body(id).dynamic() && before.state_of(id).group) insert(members, sim_.process_of(id));
  return members.empty() ? Region{} : region_of(before, members, false);
}

GroupEvents::Decided GroupEvents::regrouped(const Before& before, const Known& is_known,
                                            Cause cause, const std::vector<Successor>& successors,
                                            GroupCounters& counters) const {
  return tw::regroup(before, sim_.surroundings, is_known,
                     {cause, delivery_.observed(CollisionKind::fission),
                      delivery_.observed(CollisionKind::fusion), &sim_.present.together},
                     successors, counters);
}

Progress GroupEvents::regroup(const Key& key, std::vector<Successor>& successors, Cause cause) {
  const bool between_runs = is_edit(key);
  const Known is_known = [&](ProcessId id) { return between_runs || horizon_.is_known(id, key); };
  Decided result = regrouped(sim_.before(key), is_known, cause, successors, counters_);
  if (const Waits* waits = std::get_if<Waits>(&result)) {
    await(waits->region, key);
    return Progress::try_again;
  }
  successors = std::move(std::get<Regrouped>(result).successors);
  return Progress::done;
}

void GroupEvents::regroup_edited(const Key& key, std::vector<Successor>& successors) {
  if (!touches_groups(successors)) return;
  const Progress progress = regroup(key, successors, Cause::edit);
  TW_ASSERT(progress == Progress::done, "an edit between runs waits for nobody");
}

// An isolated body that cannot be followed any further: it stops with an error.
Progress GroupEvents::stop_driven(ProcessId id) {
  const State& tail = *sim_.graph.tail(id);
  const Key key = end_key(tail, tail.arc_end());
  std::vector<Successor> successors{make_successor(sim_.before(key), id, true)};
  successors[0].data.error = tail.trajectory().failure();
  discontinuities_.enter(key, successors);
  return Progress::done;
}

// Successors and groups that follow a check; a function of what stands before its key.
GroupEvents::Decided GroupEvents::decide(const Before& before,
                                         const std::vector<ProcessId>& concerned, Cause cause,
                                         const Known& is_known, GroupCounters& counters) const {
  const Key& key = before.key();
  std::vector<Successor> successors;
  successors.reserve(concerned.size());
  const Group* failed = nullptr;
  for (const ProcessId member : concerned) {
    const Group& theirs = *before.state(member).group;
    theirs.arc->extend(key.time);
    if (!theirs.arc->failure().empty()) failed = &theirs;
    successors.push_back(make_successor(before, member, true));
  }
  const bool stands = key.microstep > guard::most_microsteps;
  if (failed || stands) {
    const Group& group = failed ? *failed : *before.state(concerned.front()).group;
    const UserError error(
        failed ? failure_of(sim_.scene, group) : standstill_of(sim_.scene, group, key.time),
        sim_.body_of(concerned.front()).info.place);
    for (Successor& successor : successors) successor.data.error = std::make_exception_ptr(error);
    return Regrouped{std::move(successors)};
  }
  return regrouped(before, is_known, cause, successors, counters);
}

// ---- ahead of their events ----

// Those whose arcs end at the key's time with the group's check.
std::vector<ProcessId> GroupEvents::concerned(const Before& before,
                                              const std::shared_ptr<Group>& group) const {
  return before.key().time < group->next_check() ? early_members(before, *group)
                                                 : family(before, group);
}

void GroupEvents::test_ends(Decision& decision) const {
  for (const Successor& successor : decision.successors)
    if (const auto& made = successor.data.group; made && made->key == decision.key)
      test_end(sim_.scene, sim_.surroundings, *made, decision.counters);
}

// What the check of those concerned comes to, and the arcs of their groups up to their ends; false:
// it can't be said now.  Several threads may ask at once.
bool GroupEvents::decide_ahead(Decision& decision) const {
  const Key& key = decision.key;
  const Known is_known = [&](ProcessId member) {
    return horizon_.may_be_shared(member, sim_.before(key));
  };
  const std::vector<ProcessId>& all = decision.concerned;
  if (!std::all_of(all.begin(), all.end(), is_known)) return false;
  Decided decided =
      decide(sim_.before(key, &decision.log), all, Cause::check, is_known, decision.counters);
  Regrouped* regrouped = std::get_if<Regrouped>(&decided);
  if (!regrouped) return false;
  decision.successors = std::move(regrouped->successors);
  // (what is redone is compared as it enters, untested)
  if (!sim_.options.undo_redo) test_ends(decision);
  decision.log.close();
  return true;
}

Progress GroupEvents::check(ProcessId id) {
  const State& tail = *sim_.graph.tail(id);
  if (tail.driven()) return stop_driven(id);
  TW_ASSERT(tail.group && !tail.group->at_rest, "group check of nobody");
  const std::shared_ptr<Group> group = tail.group;
  if (!group->found) {
    claims_.test_ends({&group, 1});
    return Progress::try_again;
  }
  const double when = tail.arc_end();
  Key key = group_check_key(*group, when);
  ++counters_.group_checks;

  // only after the claims of kinematic bodies, and those of all that take part, have reached its
  // time; what an error has stopped before claims no more
  bool claimed = false;
  for (const BodyId mover : sim_.kinematic) {
    const Body& body = sim_.body(mover);
    const bool stopped = sim_.graph.tail(body.process)->error != nullptr;
    for (; !stopped && sim_.process(body).claim.time < key.time; claimed = true)
      claims_.claim_window(body);
  }
  if (claimed) return Progress::try_again;
  std::vector<ProcessId> all = concerned(sim_.before(key), group);
  bool all_known = true;
  for (const ProcessId member : all) all_known = await(member, key) && all_known;
  if (!all_known) return Progress::try_again;

  // the least of them gives the key; some may have left by lesser keys of this instant: the more,
  // the larger the id, so it only rises, and this ends
  while (key.id != number(all.front())) {
    key.id = number(all.front());
    all = concerned(sim_.before(key), group);
  }
  ahead_.decide_instant(when);
  if (const auto decision = ahead_.take(key, all)) {
    counters_.add(decision->counters);
    discontinuities_.enter(key, decision->successors);
    return Progress::done;
  }
  const Known is_known = [&](ProcessId member) { return horizon_.is_known(member, key); };
  const Cause cause = when < group->next_check() ? Cause::early_check : Cause::check;
  Decided decision = decide(sim_.before(key), all, cause, is_known, counters_);
  if (const Waits* waits = std::get_if<Waits>(&decision)) {
    await(waits->region, key);
    return Progress::try_again;
  }
  discontinuities_.enter(key, std::get<Regrouped>(decision).successors);
  return Progress::done;
}

}  // namespace tw
