// What the loop does for impacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/impact-events.h"

#include <algorithm>

#include "base/constants.h"
#include "base/parallel.h"
#include "groups/joints.h"
#include "groups/regroup.h"
#include "kernel/active-pairs.h"
#include "kernel/claims.h"
#include "kernel/delivery.h"
#include "kernel/discontinuities.h"
#include "kernel/impact.h"
#include "kernel/simulation.h"
#include "kernel/state-view.h"

namespace tw {

ImpactEvents::ImpactEvents(Simulation& simulation, const ActivePairs& pairs,
                           Discontinuities& discontinuities, GroupEvents& groups, Claims& claims,
                           const Delivery& delivery)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      discontinuities_(discontinuities),
      groups_(groups),
      claims_(claims),
      delivery_(delivery) {}

bool ImpactEvents::wants_collision(const Body& a, const Body& b) const {
  if (delivery_.observed(CollisionKind::collision)) return true;
  for (const CollisionCallbackDef& def : callbacks_)
    if (match_specificity(def.a, def.b, a.contact, b.contact)) return true;
  return false;
}

// Every callback that matches, in order of registration.
void ImpactEvents::run_callbacks(const Collision& collision, const Before& before, Successor& a,
                                 Successor& b) const {
  for (const CollisionCallbackDef& def : callbacks_) {
    if (!match_specificity(def.a, def.b, a.body->contact, b.body->contact)) continue;
    // the sides in the order given; where both match either way, the body added first comes first
    const bool straight =
        side_matches(def.a, a.body->contact) && side_matches(def.b, b.body->contact);
    SuccessorView view_a(sim_.scene, before.state(a.process()), a, collision.key, false);
    SuccessorView view_b(sim_.scene, before.state(b.process()), b, collision.key, false);
    ++counters_.callbacks_run;
    if (straight)
      def.callback->run(collision, false, view_a, view_b);
    else
      def.callback->run(collision, true, view_b, view_a);
  }
}

// Successors of all whom it concerns; a function of what stands before its key, but for callbacks.
GroupEvents::Decided ImpactEvents::decide(std::uint32_t pair, const Before& before,
                                          const Known& is_known, GroupCounters& counters) const {
  const Key& key = before.key();
  const Body& body_a = sim_.body(pairs_[pair].a);
  const Body& body_b = sim_.body(pairs_[pair].b);
  std::vector<Successor> successors;
  successors.reserve(2);
  successors.push_back(make_successor(before, body_a.process, body_a.dynamic()));
  successors.push_back(make_successor(before, body_b.process, body_b.dynamic()));
  share_joints(successors);
  const Wanted wanted{wants_collision(body_a, body_b), delivery_.observed(CollisionKind::fusion)};
  const auto [soft, points, collision] =
      compute_impact(sim_.scene, sim_.surroundings, key, wanted, successors[0], successors[1]);

  // callbacks see the successors; their errors stop the receivers, speculatively
  if (collision && collision->kind == CollisionKind::collision && !successors[0].data.error &&
      !callbacks_.empty()) {
    try {
      run_callbacks(*collision, before, successors[0], successors[1]);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      successors[0].data.error = successors[1].data.error = std::current_exception();
    }
  }
  if (collision)
    (successors[0].enters() ? successors[0] : successors[1]).data.report =
        std::make_shared<const Report>(Report{*collision});
  if (successors[0].data.error)
    discontinuities_.stop_group_mates(before, successors);
  else if (soft || touches_groups(successors))
    return groups_.regrouped(before, is_known, {soft ? Cause::fusion : Cause::impact, points},
                             successors, counters);
  return Regrouped{std::move(successors)};
}

// ---- several at once ----

// Two in flight are done with sooner than a helper is told of them.
bool ImpactEvents::concerns_group(std::uint32_t pair) const {
  const auto in_group = [&](BodyId id) {
    return sim_.body(id).dynamic() && sim_.graph.tail(sim_.process_of(id))->group;
  };
  return in_group(pairs_[pair].a) || in_group(pairs_[pair].b);
}

// Where an impact may soon be felt.
Aabb ImpactEvents::room_of(std::uint32_t pair) const {
  Aabb room;
  for (const BodyId id : {pairs_[pair].a, pairs_[pair].b}) {
    if (!sim_.body(id).dynamic()) continue;
    Aabb box = sim_.grid.box(id);
    box.grow(cost::felt_in_radii * sim_.body(id).radius);
    room.add(box);
  }
  return room;
}

// The impact and those that come soon, somewhere else.
void ImpactEvents::find_next(std::uint32_t first) {
  soon_.clear();
  sim_.queue.visit_soon(cost::events_looked_ahead, [&](const Event& event) {
    if (event.kind == EventKind::pair && event.subject != first && pairs_[event.subject].pending &&
        concerns_group(event.subject))
      soon_.push_back(event.subject);
  });
  std::sort(soon_.begin(), soon_.end(),
            [&](std::uint32_t x, std::uint32_t y) { return pairs_[x].impact < pairs_[y].impact; });
  next_.clear();
  rooms_.clear();
  const auto add = [&](std::uint32_t pair, const Aabb& room) {
    next_.push_back(std::make_unique<Decision>());
    next_.back()->pair = pair;
    next_.back()->key = pairs_[pair].impact;
    rooms_.push_back(room);
  };
  add(first, room_of(first));
  for (const std::uint32_t pair : soon_) {
    if (next_.size() == cost::impacts_at_once) break;
    const Aabb room = room_of(pair);
    if (std::none_of(rooms_.begin(), rooms_.end(),
                     [&](const Aabb& other) { return other.overlaps(room); }))
      add(pair, room);
  }
  std::sort(next_.begin(), next_.end(),
            [](const auto& x, const auto& y) { return x->key < y->key; });
}

void ImpactEvents::decide_ahead(Decision& decision) const {
  const Before before = sim_.before(decision.key, &decision.log);
  const BodyId struck[] = {pairs_[decision.pair].a, pairs_[decision.pair].b};
  if (!groups_.may_be_struck(struck, before)) return;
  const Known is_known = [&](ProcessId id) { return groups_.may_be_read(id, before); };
  decision.result = decide(decision.pair, before, is_known, decision.counters);
  decision.made = std::holds_alternative<Regrouped>(decision.result);
  decision.log.close(sim_.graph);
}

// Enters those whose decisions still hold, in order; those who have new arcs claim together.
void ImpactEvents::enter_next() {
  movers_.clear();
  for (const auto& decision : next_) {
    const Pair& pair = pairs_[decision->pair];
    if (!decision->made || !pair.pending || pair.impact != decision->key ||
        !decision->log.holds(sim_.graph))
      continue;
    counters_.add(decision->counters);
    std::vector<Successor>& successors = std::get<Regrouped>(decision->result).successors;
    for (const Successor& successor : successors)
      if (successor.starts_arc() && successor.body->dynamic()) movers_.push_back(successor.body);
    discontinuities_.enter(decision->key, successors);
  }
  std::sort(movers_.begin(), movers_.end(),
            [](const Body* x, const Body* y) { return x->id() < y->id(); });
  movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());
  std::erase_if(movers_, [&](const Body* body) {
    return sim_.process(*body).claim.time >= sim_.graph.tail(body->process)->arc_end();
  });
  claims_.claim_windows(movers_);
}

// False: the first one is still to be processed.
bool ImpactEvents::process_together(std::uint32_t first) {
  // procedures run on one thread; what is undone and redone is looked at one by one
  if (!Team::current() || !callbacks_.empty() || sim_.options.undo_redo ||
      sim_.policy->synchronous() || !concerns_group(first))
    return false;
  find_next(first);
  if (next_.size() < 2) return false;
  const Key key = pairs_[first].impact;
  const BodyId struck[] = {pairs_[first].a, pairs_[first].b};
  if (!groups_.may_be_struck(struck, sim_.before(key))) return false;
  each_in_parallel(next_.size(), 1, [&](std::size_t i) { decide_ahead(*next_[i]); });
  enter_next();
  return !pairs_[first].pending || pairs_[first].impact != key;
}

// The pending impact of an active pair.
Progress ImpactEvents::process(std::uint32_t pair) {
  if (process_together(pair)) return Progress::done;
  const Key key = pairs_[pair].impact;
  // only after the claims of the receivers, and of those they touch, have reached its time
  const BodyId struck[] = {pairs_[pair].a, pairs_[pair].b};
  if (!groups_.await_struck(struck, key)) return Progress::try_again;
  const Known is_known = [&](ProcessId id) { return groups_.known(id, key); };
  GroupEvents::Decided decided = decide(pair, sim_.before(key), is_known, counters_);
  if (const Waits* waits = std::get_if<Waits>(&decided)) {
    groups_.await(waits->region, key);
    return Progress::try_again;
  }
  discontinuities_.enter(key, std::get<Regrouped>(decided).successors);
  return Progress::done;
}

}  // namespace tw
