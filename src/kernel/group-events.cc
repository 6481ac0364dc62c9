// What the loop does for contact groups: waiting until arcs are known, regrouping, group checks.
//
// The decisions are those of groups/, functions of what stands before a key; here are the claims
// and events around them.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "groups/check-times.h"
#include "groups/end-test.h"
#include "groups/group-check.h"
#include "groups/regroup.h"
#include "kernel/kernel.h"

namespace tw {

// Whether the process's arc ends at the time of the key, and the check that stands there comes
// first.
bool Kernel::own_check_before(ProcessId id, const Key& key) const {
  if (!body_of(id).dynamic()) return false;
  const State& tail = *graph.tail(id);
  if (tail.error || natural_end(tail) != key.time) return false;
  Key check = group_check_key(*tail.group, key.time);
  check.id = number(id);
  return tail.key < check && check < key;
}

// Whether its claims reach the key.
bool Kernel::claims_reach(ProcessId id, const Key& key) const {
  // checks and callbacks come before the impacts of their instant
  const bool at_time = key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
  const Body& body = body_of(id);
  return body.fixed() || graph.tail(id)->error ||
         (at_time ? process(body).claim.time >= key.time : ready(body, key));
}

// Whether the arcs of the process are known as far as the key: nothing can come before it.
bool Kernel::known(ProcessId id, const Key& key) const {
  // its own check of this instant would be forgotten if its arc were changed by a greater key
  const bool at_time = key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
  return !(at_time && own_check_before(id, key)) && claims_reach(id, key);
}

// Claims windows of a process until its arcs are known to `key`.  False: something else comes
// first, perhaps; whoever asked has done nothing, and is asked again when its event is due once
// more.
bool Kernel::await(ProcessId id, const Key& key) {
  if (known(id, key)) return true;
  const bool only_its_check = claims_reach(id, key);
  while (!claims_reach(id, key) && process(body_of(id)).claim.time < natural_end(*graph.tail(id)))
    claim_window(body_of(id));
  // the group check that stands before the key
  if (only_its_check || !claims_reach(id, key)) static_cast<void>(check_group(id));
  return false;
}

bool Kernel::await(const Region& region, const Key& key) {
  bool all_known = true;
  for (const std::vector<ProcessId>* part : {&region.inside, &region.border, &region.depends_on})
    for (const ProcessId id : *part) all_known = await(id, key) && all_known;
  return all_known;
}

// The groups that follow a discontinuity that changed some of the successors; adds those of all
// others that take part.
Progress Kernel::regroup(const Key& key, std::vector<Successor>& successors, Cause cause) {
  const bool between_runs = is_edit(key);
  const Known is_known = [&](ProcessId id) { return between_runs || known(id, key); };
  auto result =
      tw::regroup(before(key), surroundings_, is_known, {cause, observed(CollisionKind::fission)},
                  successors, present.counters);
  if (const Waits* waits = std::get_if<Waits>(&result)) {
    await(waits->region, key);
    return Progress::try_again;
  }
  successors = std::move(std::get<Regrouped>(result).successors);
  return Progress::done;
}

// After an edit between runs.
void Kernel::regroup_edited(const Key& key, std::vector<Successor>& successors) {
  if (!touches_groups(successors)) return;
  const Progress progress = regroup(key, successors, Cause::edit);
  TW_ASSERT(progress == Progress::done, "an edit between runs waits for nobody");
}

// Every member of a moving group waits for the end of its arc; who comes first acts for all.
void Kernel::schedule_group_check(ProcessId id) {
  Process& waiting = processes[number(id)];
  const State* tail = graph.tail(id);
  const double end = tail && !tail->error ? natural_end(*tail) : never;
  if (end == never) {
    queue.withdraw(waiting.group_check);
    return;
  }
  Key key = group_check_key(*tail->group, end);
  key.id = number(id);
  queue.schedule(waiting.group_check,
                 make_event(key, EventKind::group_check, number(id), waiting.head_start));
}

// Finds where the arcs of the group end, before anybody relies on them.
void Kernel::test_group_end(Group& group) {
  test_end(scene, surroundings_, group, present.counters);
  for (const ProcessId id : group.members)
    if (graph.tail(id)->group.get() == &group) schedule_group_check(id);
}

Progress Kernel::check_group(ProcessId id) {
  const State& tail = *graph.tail(id);
  TW_ASSERT(tail.group && !tail.group->at_rest, "group check of nobody");
  const std::shared_ptr<Group> group = tail.group;
  if (!group->end_tested) {
    test_group_end(*group);
    return Progress::try_again;
  }
  const double when = natural_end(tail);
  Key key = group_check_key(*group, when);
  ++present.counters.group_checks;

  // only after the claims of kinematic bodies, and those of all that take part, have reached its
  // time
  bool claimed = false;
  for (const BodyId mover : kinematic)
    for (; process(scene.body(mover)).claim.time < key.time; claimed = true)
      claim_window(*scene.bodies[mover]);
  if (claimed) return Progress::try_again;
  const bool early = when < group->next_check;
  const auto all_concerned = [&] {
    return early ? early_members(before(key), *group) : family(before(key), group);
  };
  std::vector<ProcessId> concerned = all_concerned();
  bool all_known = true;
  for (const ProcessId member : concerned) all_known = await(member, key) && all_known;
  if (!all_known) return Progress::try_again;

  // the least of them gives the key; some may have left by lesser keys of this instant: the more,
  // the larger the id, so it only rises, and this ends
  while (key.id != number(concerned.front())) {
    key.id = number(concerned.front());
    concerned = all_concerned();
  }
  std::vector<Successor> successors;
  successors.reserve(concerned.size());
  const Group* failed = nullptr;
  for (const ProcessId member : concerned) {
    const Group& theirs = *before(key).state(member).group;
    theirs.arc->extend(key.time);
    if (!theirs.arc->failure().empty()) failed = &theirs;
    successors.push_back(make_successor(before(key), member, true));
  }
  if (failed) {
    const UserError error(failure_of(scene, *failed), body_of(concerned.front()).info.place);
    for (Successor& successor : successors) successor.data.error = std::make_exception_ptr(error);
  } else if (regroup(key, successors, early ? Cause::early_check : Cause::check) ==
             Progress::try_again) {
    return Progress::try_again;
  }
  enter_discontinuity(key, successors);
  return Progress::done;
}

}  // namespace tw
