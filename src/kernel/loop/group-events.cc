// What the loop does for contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/group-events.h"

#include <algorithm>
#include <unordered_set>

#include "base/constants.h"
#include "base/parallel.h"
#include "groups/ends/check-times.h"
#include "groups/ends/end-test.h"
#include "groups/ends/group-check.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/delivery.h"
#include "timeline/swept-bounds.h"

namespace tw {

GroupEvents::GroupEvents(Simulation& simulation, Claims& claims, Discontinuities& discontinuities,
                         const Delivery& delivery)
    : sim_(simulation),
      counters_(simulation.present.counters),
      claims_(claims),
      discontinuities_(discontinuities),
      delivery_(delivery) {}

// Whether the process's arc ends at the time of the key, and the check that stands there comes
// first.
bool GroupEvents::own_check_before(ProcessId id, const Key& key) const {
  if (!sim_.body_of(id).dynamic()) return false;
  const State& tail = *sim_.graph.tail(id);
  if (tail.error || tail.arc_end() != key.time) return false;
  const Key check = end_key(tail, key.time);
  return tail.key < check && check < key;
}

// Whether its claims reach the key.
bool GroupEvents::claims_reach(ProcessId id, const Key& key) const {
  // checks and callbacks come before the impacts of their instant
  const bool at_time = key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
  const Body& body = sim_.body_of(id);
  return body.fixed() || sim_.graph.tail(id)->error ||
         (at_time ? sim_.process(body).claim.time >= key.time : claims_.reach(body, key));
}

bool GroupEvents::known(ProcessId id, const Key& key) const {
  // its own check of this instant would be forgotten if its arc were changed by a greater key
  const bool at_time = key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
  return !(at_time && own_check_before(id, key)) && claims_reach(id, key);
}

bool GroupEvents::await(ProcessId id, const Key& key) {
  if (known(id, key)) return true;
  const bool only_its_check = claims_reach(id, key);
  while (!claims_reach(id, key) &&
         sim_.process(sim_.body_of(id)).claim.time < sim_.graph.tail(id)->arc_end())
    claims_.claim_window(sim_.body_of(id));
  // the group check that stands before the key
  if (only_its_check || !claims_reach(id, key)) static_cast<void>(check(id));
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
  const Known is_known = [&](ProcessId id) { return between_runs || known(id, key); };
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

// The group whose common check the event is, if that can be decided ahead of it; else null.
std::shared_ptr<Group> GroupEvents::checked_by(const Event& event) const {
  const State& tail = *sim_.graph.tail(ProcessId{event.subject});
  const std::shared_ptr<Group>& group = tail.group;
  const double when = event.key.time;
  if (!group || tail.error || group->at_rest || !group->found || !group->arc->complete() ||
      group->key.time >= when || tail.arc_end() != when || group->next_check() != when)
    return nullptr;
  for (const BodyId mover : sim_.kinematic) {
    const Body& body = sim_.body(mover);
    if (!sim_.graph.tail(body.process)->error && sim_.process(body).claim.time < when)
      return nullptr;
  }
  return group;
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
  const Known is_known = [&](ProcessId member) { return may_be_read(member, sim_.before(key)); };
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

// The groups whose checks are due at the queue's first instant, the largest first: who else decides
// has done the others by the time that it is ready, and helps with the loops within it.
Groups GroupEvents::due_groups(double when) const {
  std::vector<Event> events;
  sim_.queue.first_ones(events);
  Groups groups;
  for (const Event& event : events) {
    if (event.kind != EventKind::group_check || event.key.time != when) continue;
    if (const std::shared_ptr<Group> group = checked_by(event)) groups.push_back(group);
  }
  sort_once(groups);
  std::stable_sort(groups.begin(), groups.end(), [](const auto& x, const auto& y) {
    return x->members.size() > y->members.size();
  });
  return groups;
}

// The families whose checks are due then, each with whom it concerns: each once, for what impacts
// have divided are many groups, and each of them leads to all.
std::vector<std::unique_ptr<Decision>> GroupEvents::due_families(double when) const {
  std::vector<std::unique_ptr<Decision>> families;
  std::unordered_set<const Group*> done;
  for (const std::shared_ptr<Group>& group : due_groups(when)) {
    if (done.contains(group.get())) continue;
    auto decision = std::make_unique<Decision>();
    Key& key = decision->key = group_check_key(*group, when);
    std::vector<ProcessId>& all = decision->concerned;
    Groups parts;
    do {
      if (!all.empty()) key.id = number(all.front());
      all = family(sim_.before(key, &decision->log), group, &parts);
    } while (!all.empty() && key.id != number(all.front()));
    for (const std::shared_ptr<Group>& part : parts) done.insert(part.get());
    if (!all.empty()) families.push_back(std::move(decision));
  }
  return families;
}

// Checks of one instant hardly ever concern each other: they are decided side by side, each as if
// it were the first; what has to do with another one after all is decided anew by its event.
void GroupEvents::decide_instant(double when) {
  if (decided_at_ == when || !Team::current()) return;
  std::vector<std::unique_ptr<Decision>> decisions = due_families(when);
  // (a single one in between, an early end, forgets nothing)
  if (decisions.size() < 2) return;
  decided_at_ = when;
  ahead_.forget_before(sim_.present.gvt);
  each_in_parallel(decisions.size(), 1, [&](std::size_t i) {
    if (!decide_ahead(*decisions[i])) decisions[i].reset();
  });
  counters_.checks_decided_ahead += ahead_.add(std::move(decisions));
}

bool GroupEvents::amid_decisions() const {
  return !sim_.queue.empty() && ahead_.has_at(sim_.queue.top().key.time);
}

// Whether several threads may look at the process's arc before the key at once: it is known, and
// complete.
bool GroupEvents::may_be_read(ProcessId id, const Before& before) const {
  const Group* group = before.state(id).group.get();
  return (!group || group->at_rest || group->arc->complete()) && known(id, before.key());
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
  decide_instant(when);
  if (const auto decision = ahead_.take(key, sim_.graph); decision && decision->concerned == all) {
    counters_.add(decision->counters);
    ++counters_.check_decisions_used;
    discontinuities_.enter(key, decision->successors);
    return Progress::done;
  }
  const Known is_known = [&](ProcessId member) { return known(member, key); };
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
