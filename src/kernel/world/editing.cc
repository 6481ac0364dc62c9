// Changes between runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/world/editing.h"

#include <algorithm>

#include "groups/joints/joints.h"
#include "groups/regroup/region.h"
#include "groups/regroup/regroup.h"
#include "kernel/loop/discontinuities.h"
#include "kernel/loop/group-events.h"
#include "kernel/loop/simulation.h"
#include "kernel/world/state-view.h"

namespace tw {

// Of an edit that concerns these.  After whatever they have done at this instant, where that is
// final; else before everything there: a callback that stopped the run, or an impact that an
// interrupt left, sees what was changed, and doesn't take it back by coming earlier.
Key Editing::edit_key(const std::vector<ProcessId>& concerned) const {
  if (!sim_.present.due.inclusive)
    return {sim_.present.time, 0, KeyKind::early_edit, sim_.present.edits};
  std::uint32_t microstep = 1;
  for (const ProcessId member : concerned)
    for (const State* s = sim_.graph.tail(member); s && s->key.time >= sim_.present.time;
         s = s->prev)
      if (s->key.time == sim_.present.time) microstep = std::max(microstep, s->key.microstep + 1);
  return {sim_.present.time, microstep, KeyKind::edit, sim_.present.edits};
}

// Of an edit of these (ascending): it concerns what touches them, too.
Key Editing::key_around(const std::vector<ProcessId>& edited) const {
  const Region region = region_of(sim_.before(sim_.present.key()), edited, true);
  std::vector<ProcessId> concerned = region.inside;
  concerned.insert(concerned.end(), region.border.begin(), region.border.end());
  return edit_key(concerned);
}

// Whether anything is other than it was.
bool Editing::changes(const Key& key, const std::vector<Successor>& successors) const {
  return std::any_of(successors.begin(), successors.end(), [&](const Successor& successor) {
    const State& was = sim_.before(key).state(successor.process());
    return successor.starts_arc() || successor.data.slots != was.slots ||
           successor.data.random != was.random;
  });
}

// Its number is taken only now.
void Editing::enter(const Key& key, std::vector<Successor>& successors) {
  groups_.regroup_edited(key, successors);
  ++sim_.present.edits;
  discontinuities_.enter(key, successors);
}

Editing::Edited Editing::edit(BodyId id, const std::function<void(StateView&)>& change) {
  sim_.require_between_runs("a body was changed");
  const Body& body = sim_.body(id);
  const Key key = key_around({body.process});
  std::vector<Successor> successors{make_successor(sim_.before(key), body.process, false)};
  successors[0].role = Role::record;
  const Vec3 x_before = successors[0].point.x;
  const Quat q_before = successors[0].point.q;
  SuccessorView view(sim_.scene, sim_.before(key).state(body.process), successors[0], key, true);
  change(view);
  Edited edited{key, body.process, {}};
  if (!changes(key, successors)) return edited;
  const bool placed = successors[0].placed;
  const PoseTwist now = successors[0].point;
  enter(key, successors);
  if (body.multibody) {
    if (placed) edited.placed = body.multibody->links;
    return edited;
  }
  // what is put where it is may be pressed in; to the body's frame and back costs rounding
  constexpr double rounding = 1e-12;
  const bool stays = (now.x - x_before).norm() <= rounding * (x_before.norm() + body.extent()) &&
                     now.q.angularDistance(q_before) <= rounding;
  if (!stays) edited.placed = {id};
  return edited;
}

void Editing::take_back(const Edited& edited) {
  discontinuities_.roll_back(edited.process, edited.key);
  --sim_.present.edits;
}

void Editing::edit_pair(BodyId a, BodyId b,
                        const std::function<void(SuccessorView&, SuccessorView&)>& change) {
  sim_.require_between_runs("two bodies were changed");
  std::vector<ProcessId> both;
  for (const BodyId id : {a, b}) insert(both, sim_.process_of(id));
  const Key key = key_around(both);
  std::vector<Successor> successors;
  for (const ProcessId process : both)
    successors.push_back(make_successor(sim_.before(key), process, false));
  share_joints(successors);
  std::vector<SuccessorView> views;
  for (Successor& successor : successors)
    views.emplace_back(sim_.scene, sim_.before(key).state(successor.process()), successor, key,
                       false);
  const auto view_of = [&](BodyId id) -> SuccessorView& {
    return sim_.process_of(id) == both.front() ? views.front() : views.back();
  };
  change(view_of(a), view_of(b));
  if (changes(key, successors)) enter(key, successors);
}

void Editing::bring_together(BodyId a, BodyId b) {
  std::vector<ProcessId> moving;
  for (const BodyId id : {a, b})
    if (sim_.body(id).dynamic()) insert(moving, sim_.process_of(id));
  const Key key = key_around(moving);
  std::vector<Successor> successors;
  for (const BodyId id : {a, b})
    successors.push_back(
        make_successor(sim_.before(key), sim_.process_of(id), sim_.body(id).dynamic()));
  share_joints(successors);
  const Progress progress = groups_.regroup(key, successors, Cause::fusion);
  TW_ASSERT(progress == Progress::done, "an edit between runs waits for nobody");
  discontinuities_.enter(key, successors);
}

void Editing::set_gravity(const Vec3& gravity) {
  sim_.require_between_runs("gravity was set");
  TW_REQUIRE(is_finite(gravity), "gravity is not finite; expected #(x y z) in m/s^2");
  if (gravity == sim_.present.settings.gravity) return;
  sim_.present.settings.gravity = gravity;
  sim_.scale_joints();
  // a body that is still at its birth needs no discontinuity
  const auto newborn = [&](BodyId id) {
    return !sim_.present.begun && !sim_.body(id).multibody &&
           !sim_.graph.tail(sim_.process_of(id))->prev;
  };
  for (const auto& body : sim_.scene.bodies)
    if (body->dynamic() && newborn(body->id())) {
      State* tail = sim_.graph.tail(body->process);
      tail->acceleration = gravity + tail->force / body->mass;
      let_move(sim_.scene, *body, *tail);
    }
  edit_together([&](BodyId id) { return !newborn(id); },
                [&](Successor& successor) {
                  successor.data.acceleration =
                      gravity + successor.data.force / successor.body->mass;
                });
}

// Gives new arcs, changed by `change`, to all dynamic bodies that are `concerned` and to those that
// hang together with them: one edit for all that hang together, so that no group is made in between
// whose members are half changed.
void Editing::edit_together(const std::function<bool(BodyId)>& concerned,
                            const std::function<void(Successor&)>& change) {
  std::vector<bool> done(sim_.processes.size(), false);
  for (const auto& body : sim_.scene.bodies) {
    if (!body->dynamic() || done[number(body->process)] || !concerned(body->id())) continue;
    const std::vector<ProcessId> together =
        sim_.before(sim_.present.key()).hanging_together(body->process);
    const Key key = edit_key(together);
    std::vector<Successor> successors;
    successors.reserve(together.size());
    for (const ProcessId process : together) {
      done[number(process)] = true;
      successors.push_back(make_successor(sim_.before(key), process, true));
      change(successors.back());
    }
    enter(key, successors);
  }
}

void Editing::renew_groups(std::vector<BodyId> concerned) {
  if (concerned.empty()) return;
  std::sort(concerned.begin(), concerned.end());
  edit_together(
      [&](BodyId id) {
        const State* tail = sim_.graph.tail(sim_.process_of(id));
        return tail->group && !tail->error &&
               std::binary_search(concerned.begin(), concerned.end(), id);
      },
      [](Successor&) {});
}

void Editing::let_go_of(BodyId id) {
  edit_together(
      [&](BodyId other) {
        const State& state = sim_.before(sim_.present.key()).state_of(other);
        if (hangs_on(state.forces, id)) return true;
        if (!state.group || state.error) return false;
        const auto in_contact = state.group->pairs_of(state.member);
        return std::any_of(in_contact.begin(), in_contact.end(), [&](std::uint32_t number) {
          const std::uint64_t pair = state.group->pairs[number].id;
          return first_of(pair) == id || second_of(pair) == id;
        });
      },
      [&](Successor& successor) {
        ForcesPtr& forces = successor.data.forces;
        if (hangs_on(forces, id)) forces = without_those_on(forces, id);
      });
}

}  // namespace tw
