// What the loop does for impacts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/impact-events.h"

#include <algorithm>

#include "groups/joints/joints.h"
#include "groups/regroup/regroup.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/impact.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/delivery.h"
#include "kernel/world/state-view.h"

namespace tw {

ImpactEvents::ImpactEvents(Simulation& simulation, const Horizon& horizon, const ActivePairs& pairs,
                           Discontinuities& discontinuities, const PairChecks& checks,
                           GroupEvents& groups, const Delivery& delivery)
    : sim_(simulation),
      counters_(simulation.present.counters),
      horizon_(horizon),
      pairs_(pairs),
      discontinuities_(discontinuities),
      groups_(groups),
      delivery_(delivery),
      ahead_(simulation, horizon, pairs, checks,
             [this](BodyId a, BodyId b, const Before& before, Decision& decision) {
               decide_ahead(a, b, before, decision);
             }) {}

namespace {

// The sides by which a callback is about the two; null: it is not.
const CollisionCallbackDef::Sides* sides_for(const CollisionCallbackDef& def, const Body& a,
                                             const Body& b) {
  for (const auto& sides : def.sides)
    if (match_specificity(sides.first, sides.second, a.contact, b.contact)) return &sides;
  return nullptr;
}

}  // namespace

bool ImpactEvents::is_called(const CollisionCallback* callback) const {
  return std::any_of(callbacks_.begin(), callbacks_.end(), [&](const CollisionCallbackDef& def) {
    return def.callback.get() == callback;
  });
}

bool ImpactEvents::remove(const CollisionCallback* callback) {
  return std::erase_if(callbacks_, [&](const CollisionCallbackDef& def) {
           return def.callback.get() == callback;
         }) > 0;
}

bool ImpactEvents::wants_collision(const Body& a, const Body& b) const {
  if (delivery_.observed(CollisionKind::collision)) return true;
  for (const CollisionCallbackDef& def : callbacks_)
    if (sides_for(def, a, b)) return true;
  return false;
}

// Every callback that matches, in order of registration.
void ImpactEvents::run_callbacks(const Collision& collision, const Before& before, Successor& a,
                                 Successor& b) const {
  for (const CollisionCallbackDef& def : callbacks_) {
    const auto* const sides = sides_for(def, *a.body, *b.body);
    if (!sides) continue;
    // the sides in the order given; where both match either way, the body added first comes first
    const bool straight =
        side_matches(sides->first, a.body->contact) && side_matches(sides->second, b.body->contact);
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
GroupEvents::Decided ImpactEvents::decide(BodyId a, BodyId b, const Before& before,
                                          const Known& is_known, GroupCounters& counters) const {
  const Body &body_a = sim_.body(a), &body_b = sim_.body(b);
  std::vector<Successor> successors;
  successors.reserve(2);
  successors.push_back(make_successor(before, body_a.process, body_a.dynamic()));
  successors.push_back(make_successor(before, body_b.process, body_b.dynamic()));
  share_joints(successors);
  const Wanted wanted{wants_collision(body_a, body_b), delivery_.observed(CollisionKind::fusion)};
  const std::variant<Impact, Waits> computed =
      compute_impact(before, sim_.surroundings, is_known, wanted, successors);
  if (const Waits* waits = std::get_if<Waits>(&computed)) return *waits;
  const auto& [soft, collision] = std::get<Impact>(computed);

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
    return groups_.regrouped(before, is_known, soft ? Cause::fusion : Cause::impact, successors,
                             counters);
  return Regrouped{std::move(successors)};
}

void ImpactEvents::decide_ahead(BodyId a, BodyId b, const Before& before,
                                Decision& decision) const {
  // whoever may be read is known
  const Known is_known = [&](ProcessId id) {
    before.state(id);
    return true;
  };
  GroupEvents::Decided decided = decide(a, b, before, is_known, decision.counters);
  decision.successors = std::move(std::get<Regrouped>(decided).successors);
  groups_.test_ends(decision);
}

void ImpactEvents::look_ahead(const Event& event) {
  // callbacks are the loop's own; what is redone is compared as it enters, untested
  if (!callbacks_.empty() || sim_.options.undo_redo) return;
  ahead_.look(event);
}

// The pending impact of an active pair.
Progress ImpactEvents::process(std::uint32_t pair) {
  const Key key = pairs_[pair].impact;
  // only after the claims of the receivers, and of those they touch, have reached its time
  const BodyId struck[] = {pairs_[pair].a, pairs_[pair].b};
  if (const std::unique_ptr<Decision> known = ahead_.take(key)) {
    counters_.add(known->counters);
    discontinuities_.enter(key, known->successors);
    return Progress::done;
  }
  if (!groups_.await_struck(struck, key)) return Progress::try_again;
  const Known is_known = [&](ProcessId id) { return horizon_.is_known(id, key); };
  GroupEvents::Decided decided =
      decide(struck[0], struck[1], sim_.before(key), is_known, counters_);
  if (const Waits* waits = std::get_if<Waits>(&decided)) {
    groups_.await(waits->region, key);
    return Progress::try_again;
  }
  discontinuities_.enter(key, std::get<Regrouped>(decided).successors);
  return Progress::done;
}

}  // namespace tw
