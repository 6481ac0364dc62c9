// Group checks of one instant, decided side by side.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/checks-ahead.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "groups/ends/check-times.h"
#include "groups/ends/group-check.h"
#include "kernel/loop/simulation.h"

namespace tw {

ChecksAhead::ChecksAhead(Simulation& simulation, Decide decide)
    : sim_(simulation), decide_(std::move(decide)) {}

// The group whose common check the event is, if that can be decided ahead of it; else null.
std::shared_ptr<Group> ChecksAhead::checked_by(const Event& event) const {
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

// The groups whose checks are due at the queue's first instant, the largest first: who else decides
// has done the others by the time that it is ready, and helps with the loops within it.
Groups ChecksAhead::due_groups(double when) const {
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
std::vector<std::unique_ptr<Decision>> ChecksAhead::due_families(double when) const {
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

void ChecksAhead::decide_instant(double when) {
  if (decided_at_ == when || !Team::current()) return;
  std::vector<std::unique_ptr<Decision>> decisions = due_families(when);
  // (a single one in between, an early end, forgets nothing)
  if (decisions.size() < 2) return;
  decided_at_ = when;
  ahead_.forget_before(sim_.present.gvt);
  each_in_parallel(decisions.size(), 1, [&](std::size_t i) {
    if (!decide_(*decisions[i])) decisions[i].reset();
  });
  sim_.present.counters.checks_decided_ahead += ahead_.add(std::move(decisions));
}

bool ChecksAhead::amid_decisions() const {
  return !sim_.queue.empty() && ahead_.has_at(sim_.queue.top().key.time);
}

std::unique_ptr<Decision> ChecksAhead::take(const Key& key,
                                            const std::vector<ProcessId>& concerned) {
  std::unique_ptr<Decision> decision = ahead_.take(key, sim_.graph);
  if (!decision || decision->concerned != concerned) return nullptr;
  ++sim_.present.counters.check_decisions_used;
  return decision;
}

void ChecksAhead::forget() {
  ahead_.forget();
  decided_at_ = -never;
}

}  // namespace tw
