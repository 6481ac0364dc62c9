// Validators.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/check/validate.h"

#include <algorithm>
#include <cmath>

#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/claims.h"
#include "kernel/loop/simulation.h"
#include "timeline/swept-bounds.h"

namespace tw {

namespace {

bool flies_as_it_began(const State& state) {
  if (state.driven()) return true;
  if (state.forces) return false;
  const Parabola* path = state.trajectory().ballistic();
  return path && path->start == state.arc_time && path->x == state.x && path->v == state.v &&
         path->acceleration == state.acceleration;
}

}  // namespace

std::string validate_state_graph(const Simulation& simulation) {
  if (std::string broken = simulation.graph.validate(); !broken.empty()) return broken;
  for (const auto& body : simulation.scene.bodies) {
    for (const State* s = simulation.graph.head(body->process); s; s = s->next) {
      // a rollback left nothing behind a stopped process
      if (s->error && s->next) return "states after an error: " + body->info.name;
      if (s->arc_time > s->key.time) return "arc starts after its state: " + show(s->key);
      if (body->dynamic() && !s->group && !s->error && !flies_as_it_began(*s))
        return "flight of another state: " + body->info.name + " " + show(s->key);
      if (s->key.time < simulation.present.gvt && !s->committed && !s->error)
        return "state before GVT not committed: " + body->info.name + ", " + show(s->key);
      if (s->committed && s->key.time > simulation.present.gvt)
        return "committed after GVT: " + show(s->key);
    }
  }
  return "";
}

std::string validate_event_queue(const Simulation& simulation, const ActivePairs& pairs,
                                 const CallbackBook& callbacks) {
  if (!simulation.queue.validate()) return "heap order or handles of the event queue";
  for (const EventQueue::Handle handle : simulation.queue.handles()) {
    const Event& event = simulation.queue.event(handle);
    switch (event.kind) {
      case EventKind::advance:
        if (simulation.process(simulation.body(event.subject)).advance != handle)
          return "advance event of nobody";
        break;
      case EventKind::group_check: {
        const State* tail = simulation.graph.tail(simulation.process_of(event.subject));
        if (simulation.process(simulation.body(event.subject)).group_check != handle)
          return "group check of nobody";
        if (tail->driven() && tail->trajectory().failure()) break;
        if (!tail->group || tail->group->at_rest) return "group check of a dead group";
        break;
      }
      case EventKind::callback:
        if (callbacks[event.subject].event != handle) return "callback event of nobody";
        break;
      case EventKind::pair:
        if (!pairs[event.subject].live || pairs[event.subject].event != handle)
          return "check event of a dead pair";
        break;
    }
  }
  return "";
}

std::string validate_pairs(const Simulation& simulation, const ActivePairs& pairs) {
  std::size_t live = 0;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i];
    if (!pair.live) continue;
    ++live;
    const std::string where =
        simulation.body(pair.a).info.name + " and " + simulation.body(pair.b).info.name;
    if (!(pair.a < pair.b)) return "ids out of order: " + where;
    const auto lists = [&](BodyId body, std::uint32_t place) {
      return place < pairs.of(body).size() && pairs.of(body)[place] == i;
    };
    if (!lists(pair.a, pair.place_a) || !lists(pair.b, pair.place_b))
      return "pair not in its bodies' lists: " + where;
    if (pair.safe_time() < simulation.present.gvt) return "safe time before GVT: " + where;
    if (pair.pending) {
      // an impact is valid only below the next keys of both processes
      for (const BodyId id : {pair.a, pair.b}) {
        const State* s = simulation.graph.last_before(simulation.process_of(id), pair.impact);
        const State* next = s ? s->next : nullptr;
        while (next && !next->starts_arc()) next = next->next;
        if (next && next->key <= pair.impact) return "pending impact past an arc's end: " + where;
      }
      if (pair.event == EventQueue::none) return "pending impact without event: " + where;
    }
  }
  if (live != pairs.live()) return "number of live pairs";
  return "";
}

// Each dynamic body has one residence: the states of a group stand in its members' queues, all of
// them.
std::string validate_residences(const Simulation& simulation) {
  for (const auto& body : simulation.scene.bodies) {
    for (const State* s = simulation.graph.head(body->process); s; s = s->next) {
      if (!s->group || s->error) continue;
      const std::string where = body->info.name + ", " + show(s->key);
      const Group& group = *s->group;
      if (s->member >= group.members.size() || group.members[s->member] != body->process)
        return "not a member of its group: " + where;
      if (s->arc_key != group.key) return "arc and group differ in key: " + where;
      if (s->trajectory().end() < s->key.time) return "state past a group check: " + where;
      // once a group: this runs after every event
      if (s->starts_arc() && s->member == 0)
        for (const ContactPair& pair : group.pairs)
          for (const BodyId id : {first_of(pair.id), second_of(pair.id)})
            if (!group.contains(simulation.process_of(id)) &&
                std::find(group.outside.begin(), group.outside.end(), id) == group.outside.end())
              return "in contact with a group and neither in it nor outside: " +
                     simulation.body(id).info.name;
      if (s->committed || s->key != group.key) continue;
      for (const ProcessId other : group.members) {
        // what was removed at this instant has left its group's states
        if (simulation.body_of(other).info.removed) continue;
        const State* t = simulation.graph.last_at_or_before(other, s->key);
        if (!t || t->group != s->group) return "a member is elsewhere: " + where;
      }
    }
    const State* tail = simulation.graph.tail(body->process);
    const bool waits = tail->group && !tail->error && !tail->group->at_rest;
    if (waits && simulation.process(*body).group_check == EventQueue::none)
      return "a group without a check: " + body->info.name;
  }
  return "";
}

// Boxes hold the bodies from GVT to their claims (sampled), and nobody has states past a claim.
std::string validate_claims(const Simulation& simulation, const Claims& claims) {
  for (const auto& body : simulation.scene.bodies) {
    if (body->fixed() || !claims.placed(body->id()) || body->unbounded) continue;
    const State* tail = simulation.graph.tail(body->process);
    if (tail->starts_arc() && tail->key.time > simulation.process(*body).claim.time &&
        body->dynamic())
      return "state past the claim: " + body->info.name;
    for (int i = 0; i <= 4; ++i) {
      const double gvt = simulation.present.gvt, claimed = simulation.process(*body).claim.time;
      const double t = std::min(claimed, gvt + (claimed - gvt) * (0.25 * i));
      if (!std::isfinite(t) || t < gvt) continue;
      const State* s = simulation.graph.last_at_or_before_time(body->process, t);
      if (!s || s->error || (tail->error && t >= tail->key.time)) continue;
      const Aabb there = body->shape_P->bounds(s->trajectory().frame(t));
      const Aabb& box = simulation.grid.box(body->id());
      if (!box.contains(there.lo) || !box.contains(there.hi))
        return "box does not hold " + body->info.name + " at " + show(t) + " s";
    }
  }
  if (!simulation.grid.consistent()) return "spatial hash";
  return "";
}

}  // namespace tw
