// Several discontinuities of contact groups at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/look-ahead.h"

#include <algorithm>
#include <utility>

#include "base/constants.h"
#include "base/parallel.h"
#include "groups/group.h"
#include "kernel/active-pairs.h"
#include "kernel/claims.h"
#include "kernel/discontinuities.h"
#include "kernel/group-events.h"
#include "kernel/impact-events.h"
#include "kernel/simulation.h"

namespace tw {

LookAhead::LookAhead(Simulation& simulation, const ActivePairs& pairs,
                     Discontinuities& discontinuities, GroupEvents& groups, ImpactEvents& impacts,
                     Claims& claims, DecidedAhead& ahead)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      discontinuities_(discontinuities),
      groups_(groups),
      impacts_(impacts),
      claims_(claims),
      ahead_(ahead) {}

// Procedures run on one thread; what is undone and redone is looked at one by one.
bool LookAhead::shared() const {
  return Team::current() && !impacts_.calls_back() && !sim_.options.undo_redo &&
         !sim_.policy->synchronous();
}

// False: the event is none of a group, or was decided ahead.
bool LookAhead::find(const Event& event, Coming& coming) const {
  coming.key = event.key;
  if (event.kind == EventKind::pair) {
    coming.pair = event.subject;
    return pairs_[event.subject].pending && !ahead_.has(event.key) &&
           impacts_.concerns_group(event.subject);
  }
  if (event.kind != EventKind::group_check || ahead_.has_at(event.key.time)) return false;
  coming.group = groups_.checked_by(event);
  return coming.group != nullptr;
}

// Where it may soon be felt.
Aabb LookAhead::room_of(const Coming& coming) const {
  Aabb room;
  const auto add = [&](const Body& body) {
    if (!body.dynamic() || !body.shape_P) return;
    Aabb box = sim_.grid.box(body.id());
    box.grow(cost::felt_in_radii * body.radius);
    room.add(box);
  };
  if (coming.group)
    for (const ProcessId member : coming.group->members) add(sim_.body_of(member));
  else
    for (const BodyId id : {pairs_[coming.pair].a, pairs_[coming.pair].b}) add(sim_.body(id));
  return room;
}

void LookAhead::add(Coming coming) {
  const Aabb room = room_of(coming);
  for (const Aabb& other : rooms_) coming.apart = coming.apart && !other.overlaps(room);
  rooms_.push_back(room);
  const auto note = [&](const Group* group) {
    if (group) groups_chosen_.push_back(group);
  };
  if (coming.group)
    note(coming.group.get());
  else
    for (const BodyId id : {pairs_[coming.pair].a, pairs_[coming.pair].b})
      note(sim_.graph.tail(sim_.process_of(id))->group.get());
  next_.push_back(std::move(coming));
}

// Whether one of the two, or the member, is in a group that has to do with one of the chosen: what
// that comes to is not known before it has entered.
bool LookAhead::has_to_wait(const Event& event) const {
  const auto group_of = [&](ProcessId process) { return sim_.graph.tail(process)->group.get(); };
  const auto is_concerned = [&](ProcessId process) {
    const Group* group = group_of(process);
    return group &&
           std::find(groups_chosen_.begin(), groups_chosen_.end(), group) != groups_chosen_.end();
  };
  if (event.kind != EventKind::pair) return is_concerned(ProcessId{event.subject});
  const Pair& pair = pairs_[event.subject];
  return is_concerned(sim_.process_of(pair.a)) || is_concerned(sim_.process_of(pair.b));
}

// The first one, and the next few that come soon.  False: there is nothing to be done at once.
bool LookAhead::choose(const Event& first) {
  next_.clear();
  rooms_.clear();
  groups_chosen_.clear();
  Coming coming;
  if (!find(first, coming)) return false;
  add(std::move(coming));
  soon_.clear();
  sim_.queue.visit_soon(cost::events_looked_ahead, [&](const Event& event) {
    if (event.kind == EventKind::pair ? pairs_[event.subject].pending
                                      : event.kind == EventKind::group_check)
      soon_.push_back(event);
  });
  std::sort(soon_.begin(), soon_.end(),
            [](const Event& x, const Event& y) { return x.key < y.key; });
  for (std::size_t i = 0; i < soon_.size() && next_.size() < cost::decided_at_once; ++i) {
    const Event& event = soon_[i];
    if (has_to_wait(event)) continue;
    coming = {};
    if (!find(event, coming)) continue;
    // checks of one instant are decided together, and little holds beyond them
    const auto same_instant = [&](const Event& other) {
      return other.kind == EventKind::group_check && other.key.time == event.key.time &&
             !coming.group->contains(ProcessId{other.subject});
    };
    if (coming.group && std::any_of(soon_.begin(), soon_.end(), same_instant)) break;
    add(std::move(coming));
  }
  return next_.size() > 1;
}

void LookAhead::decide(Coming& coming) const {
  coming.decision = coming.group ? groups_.decide_ahead(coming.group, coming.key.time)
                                 : impacts_.decide_ahead(coming.pair);
}

// Whether what was decided of it holds, now that others have entered.
bool LookAhead::stands(const Coming& coming) const {
  if (!coming.decision->log.holds(sim_.graph)) return false;
  if (coming.group) return true;
  const Pair& pair = pairs_[coming.pair];
  return pair.pending && pair.impact == coming.key;
}

// Those that are apart, in order; those who have new arcs claim together.  False: the first one did
// not.
bool LookAhead::enter() {
  movers_.clear();
  bool first_entered = false;
  std::vector<std::unique_ptr<Decision>> kept;
  for (Coming& coming : next_) {
    if (!coming.decision) continue;
    if (!coming.apart) {
      kept.push_back(std::move(coming.decision));
      continue;
    }
    if (!stands(coming)) continue;
    Decision& decision = *coming.decision;
    counters_.add(decision.counters);
    counters_.group_checks += coming.group ? 1 : 0;
    for (const Successor& successor : decision.successors)
      if (successor.starts_arc() && successor.body->dynamic()) movers_.push_back(successor.body);
    discontinuities_.enter(decision.key, decision.successors);
    first_entered |= &coming == &next_.front();
  }
  next_.clear();
  ahead_.forget_before(sim_.present.gvt);
  ahead_.add(std::move(kept));
  std::sort(movers_.begin(), movers_.end(),
            [](const Body* x, const Body* y) { return x->id() < y->id(); });
  movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());
  std::erase_if(movers_, [&](const Body* body) {
    return sim_.process(*body).claim.time >= sim_.graph.tail(body->process)->arc_end();
  });
  claims_.claim_windows(movers_);
  return first_entered;
}

bool LookAhead::process(const Event& event) {
  if (!shared() || !choose(event)) return false;
  each_in_parallel(next_.size(), 1, [&](std::size_t i) { decide(next_[i]); });
  return enter();
}

}  // namespace tw
