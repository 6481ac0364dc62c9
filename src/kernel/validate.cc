// Validators: the kernel's invariants as functions, run after every event under --check.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

bool flies_as_it_began(const State& state) {
  const Parabola* path = state.trajectory().ballistic();
  return path && path->start == state.arc_time && path->x == state.x && path->v == state.v &&
         path->acceleration == state.acceleration;
}

}  // namespace

std::string Kernel::validate_state_graph() const {
  if (std::string broken = graph.validate(); !broken.empty()) return broken;
  for (const auto& body : bodies) {
    for (const State* s = graph.head(body->process); s; s = s->next) {
      // a rollback left nothing behind a stopped process
      if (s->error && s->next) return "states after an error: " + body->info.name;
      if (s->arc_time > s->key.time) return "arc starts after its state: " + show(s->key);
      if (body->dynamic() && !s->group && !s->error && !flies_as_it_began(*s))
        return "flight of another state: " + body->info.name + " " + show(s->key);
      if (s->key.time < gvt && !s->committed && !s->error)
        return "state before GVT not committed: " + body->info.name + ", " + show(s->key);
      if (s->committed && s->key.time > gvt) return "committed after GVT: " + show(s->key);
    }
  }
  return "";
}

std::string Kernel::validate_event_queue() const {
  if (!queue.validate()) return "heap order or handles of the event queue";
  for (const EventQueue::Handle handle : queue.handles()) {
    const Event& event = queue.event(handle);
    switch (event.kind) {
      case EventKind::advance:
        if (process(*bodies[event.subject]).advance != handle) return "advance event of nobody";
        break;
      case EventKind::group_check: {
        const State* tail = graph.tail(process_of(event.subject));
        if (process(*bodies[event.subject]).group_check != handle) return "group check of nobody";
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

std::string Kernel::validate_pairs() const {
  std::size_t live = 0;
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const Pair& pair = pairs[i];
    if (!pair.live) continue;
    ++live;
    const std::string where = bodies[pair.a]->info.name + " and " + bodies[pair.b]->info.name;
    if (!(pair.a < pair.b)) return "ids out of order: " + where;
    if (bodies[pair.a]->pairs[pair.place_a] != i || bodies[pair.b]->pairs[pair.place_b] != i)
      return "pair not in its bodies' lists: " + where;
    if (pair.safe_time() < gvt) return "safe time before GVT: " + where;
    if (pair.pending) {
      // an impact is valid only below the next keys of both processes
      for (const BodyId id : {pair.a, pair.b}) {
        const State* s = graph.last_before(process_of(id), pair.impact);
        const State* next = s ? s->next : nullptr;
        while (next && !next->starts_arc()) next = next->next;
        if (next && next->key <= pair.impact) return "pending impact past an arc's end: " + where;
      }
      if (pair.event == EventQueue::none) return "pending impact without event: " + where;
    }
  }
  if (live != counters.live_pairs) return "number of live pairs";
  return "";
}

// Each dynamic body has one residence: the states of a group stand in its members' queues, all of
// them.
std::string Kernel::validate_residences() const {
  for (const auto& body : bodies) {
    for (const State* s = graph.head(body->process); s; s = s->next) {
      if (!s->group || s->error) continue;
      const std::string where = body->info.name + ", " + show(s->key);
      const Group& group = *s->group;
      if (s->member >= group.members.size() || group.members[s->member] != body->id())
        return "not a member of its group: " + where;
      if (s->arc_key != group.key) return "arc and group differ in key: " + where;
      if (s->trajectory().end() < s->key.time) return "state past a group check: " + where;
      // once a group: this runs after every event
      if (s->starts_arc() && s->member == 0)
        for (const ContactPair& pair : group.pairs)
          for (const BodyId id : {first_of(pair.id), second_of(pair.id)})
            if (!group.contains(id) &&
                std::find(group.outside.begin(), group.outside.end(), id) == group.outside.end())
              return "linked to a group and neither in it nor outside: " + bodies[id]->info.name;
      if (s->committed || s->key != group.key) continue;
      for (const BodyId other : group.members) {
        const State* t = graph.last_at_or_before(process_of(other), s->key);
        if (!t || t->group != s->group) return "a member is elsewhere: " + where;
      }
    }
    const State* tail = graph.tail(body->process);
    const bool waits = tail->group && !tail->error && !tail->group->at_rest;
    if (waits && process(*body).group_check == EventQueue::none)
      return "a group without a check: " + body->info.name;
  }
  return "";
}

// Boxes hold the bodies from GVT to their claims (sampled), and nobody has states past a claim.
std::string Kernel::validate_claims() const {
  for (const auto& body : bodies) {
    if (body->fixed() || !body->placed || body->unbounded) continue;
    const State* tail = graph.tail(body->process);
    if (tail->starts_arc() && tail->key.time > process(*body).claim.time && body->dynamic())
      return "state past the claim: " + body->info.name;
    for (int i = 0; i <= 4; ++i) {
      const double claimed = process(*body).claim.time;
      const double t = std::min(claimed, gvt + (claimed - gvt) * (0.25 * i));
      if (!std::isfinite(t) || t < gvt) continue;
      const State* s = graph.last_at_or_before_time(body->process, t);
      if (!s || s->error || (tail->error && t >= tail->key.time)) continue;
      const Aabb there = body->shape_P->bounds(s->trajectory().frame(t));
      const Aabb& box = grid.box(body->id());
      if (!box.contains(there.lo) || !box.contains(there.hi))
        return "box does not hold " + body->info.name + " at " + show(t) + " s";
    }
  }
  if (!grid.consistent()) return "spatial hash";
  return "";
}

void Kernel::validate_all() const {
  for (const auto& broken : {validate_state_graph(), validate_event_queue(), validate_pairs(),
                             validate_residences(), validate_claims()})
    TW_ASSERT(broken.empty(), broken + " (GVT " + show(gvt) + " s)");
}

namespace {

void add(Hasher& h, const Vec3& v) {
  for (int i = 0; i < 3; ++i) h.add(v[i]);
}

void add_group(Hasher& h, const Group& group) {
  for (const double time : {group.birth, group.next_check, group.quiet_since, group.quiet_speed,
                            group.first_step, group.lightest, group.heaviest})
    h.add(time);
  h.add(std::uint64_t{group.at_rest} << 2 | std::uint64_t{group.asleep} << 1 |
        std::uint64_t{group.has_border});
  for (const auto& ids : {group.members, group.outside})
    for (const BodyId id : ids) h.add(std::uint64_t{id});
  for (const ContactPair& pair : group.pairs) {
    h.add(pair.id);
    h.add(std::uint64_t{pair.first} << 33 | std::uint64_t{pair.count} << 1 |
          std::uint64_t{pair.has_borne_load});
  }
  for (const ContactTag& tag : group.tags) {
    h.add(pair_id(tag.reference, tag.other));
    h.add(static_cast<std::uint64_t>(tag.parts));
    h.add(tag.feature);
  }
  for (const double gap : group.gaps) h.add(gap);
  for (std::uint32_t i = 0; i < group.members.size(); ++i) h.add(group.end(i));
  for (const Stillness& stillness : group.stillness) {
    for (const double number : {stillness.since, stillness.early_peak, stillness.peak})
      h.add(number);
    add(h, stillness.x);
    for (int i = 0; i < 4; ++i) h.add(stillness.q.coeffs()[i]);
  }
  for (const GroupContact& c : group.arc->start().contacts) add(h, c.stretch);
}

}  // namespace

// Every bit of a state that later motion depends on, and of its group, with its first member.
std::uint64_t Kernel::state_checksum(const State& s) const {
  Hasher h;
  h.add(state_hash(body_of(s.process), s.key, {s.x, s.q, s.v, s.L}, s));
  h.add(s.arc_time);
  h.add(s.random);
  h.add(std::uint64_t{s.impacts.count});
  h.add(s.impacts.last_time);
  for (int i = 0; i < 3; ++i) h.add(s.force[i]);
  if (s.group && s.member == 0) {
    add_group(h, *s.group);
  }
  return h.value();
}

std::uint64_t Kernel::graph_checksum() const {
  Hasher h;
  for (const auto& body : bodies)
    for (const State* s = graph.head(body->process); s; s = s->next) h.add(state_checksum(*s));
  return h.value();
}

// Of the latest states that one discontinuity made.
std::uint64_t Kernel::ring_checksum(const Key& key) const {
  Hasher h;
  for (const auto& body : bodies)
    if (const State* s = graph.tail(body->process); s->key == key) h.add(state_checksum(*s));
  return h.value();
}

std::vector<QueuedState> Kernel::state_queue(BodyId id) const {
  std::vector<QueuedState> result;
  for (const State* s = graph.head(process_of(id)); s; s = s->next)
    result.push_back(
        {s->key, s->committed, body_state(*bodies[id], s->trajectory().at(s->key.time))});
  return result;
}

}  // namespace tw
