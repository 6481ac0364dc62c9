// Claims.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/claims.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/parallel.h"
#include "groups/ends/check-times.h"
#include "groups/ends/end-test.h"
#include "groups/group.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/callback-book.h"
#include "kernel/loop/pair-checks.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/reading.h"
#include "timeline/swept-bounds.h"

namespace tw {
namespace {

// Solid half-space n.x <= offset against a box: its lowest corner along n.
bool plane_overlaps(const Body& plane, const Aabb& box) {
  const Vec3& n = plane.plane_normal;
  double lowest = 0;
  for (int i = 0; i < 3; ++i) lowest += n[i] * (n[i] > 0 ? box.lo : box.hi)[i];
  return lowest <= plane.plane_offset;
}

}  // namespace

Claims::Claims(Simulation& simulation, ActivePairs& pairs, PairChecks& checks,
               const CallbackBook& callbacks)
    : sim_(simulation),
      counters_(simulation.present.counters),
      pairs_(pairs),
      checks_(checks),
      callbacks_(callbacks) {}

void Claims::schedule_advance(const Body& body) {
  Process& process = sim_.process(body);
  // a member waits for the group check where its arc ends
  if (body.fixed() || process.claim.time >= sim_.graph.tail(body.process)->arc_end()) {
    sim_.queue.withdraw(process.advance);
    return;
  }
  // after callbacks and checks of that instant, which may start a new arc, and before its impacts
  constexpr std::uint64_t after_checks = std::uint64_t{1} << 32;
  const Key key{process.claim.time, 1, KeyKind::group_check, after_checks | body.id()};
  sim_.schedule(process.advance, key, EventKind::advance, body.id(), process.head_start);
}

void Claims::fall_back(ProcessId id, const Key& key) {
  Process& process = sim_.processes[number(id)];
  process.claim_to(std::min(process.claim, key));
  if (sim_.policy->synchronous()) {
    const State& tail = *sim_.graph.tail(id);
    if (tail.driven() && tail.key.time < key.time) tail.trajectory().halt(key.time);
  }
  schedule(id);
}

void Claims::schedule(ProcessId process) {
  schedule_advance(sim_.body_of(process));
  schedule_group_check(process);
}

void Claims::withdraw(ProcessId id) {
  sim_.queue.withdraw(sim_.processes[number(id)].advance);
  sim_.queue.withdraw(sim_.processes[number(id)].group_check);
}

// Every member of a moving group waits for the end of its arc; who comes first acts for all.
void Claims::schedule_group_check(ProcessId id) {
  Process& waiting = sim_.processes[number(id)];
  const State* tail = sim_.graph.tail(id);
  const double end = tail && !tail->error ? tail->arc_end() : never;
  if (end == never) {
    sim_.queue.withdraw(waiting.group_check);
    return;
  }
  const Key key = end_key(*tail, end);
  sim_.schedule(waiting.group_check, key, EventKind::group_check, number(id), waiting.head_start);
}

void Claims::test_ends(std::span<const std::shared_ptr<Group>> groups) {
  std::vector<GroupCounters> counters(groups.size());
  each_in_parallel(groups.size(), 1, [&](std::size_t i) {
    test_end(sim_.scene, sim_.surroundings, *groups[i], counters[i]);
  });
  for (std::size_t i = 0; i < groups.size(); ++i) {
    counters_.add(counters[i]);
    for (const ProcessId id : groups[i]->members)
      if (sim_.graph.tail(id)->group == groups[i]) schedule_group_check(id);
  }
}

double Claims::window_end(const Body& body) const {
  const State& tail = *sim_.graph.tail(body.process);
  const Process& process = sim_.process(body);
  const double start = process.claim.time;
  const double limit = sim_.policy->may_reach(sim_.queue, process);
  const double least = std::nextafter(start, never);
  const Trajectory& trajectory = tail.trajectory();
  const Parabola* path = tail.ballistic();
  if (!path && tail.group) return std::max(std::min(trajectory.end(), limit), least);
  // the next callback ends the arc as we know it; who flies on after one is likely to do so again
  double called = limit;
  const bool flies_on = path && tail.key.kind == KeyKind::callback && !tail.starts_arc();
  if (!flies_on || sim_.policy->synchronous())
    for (const std::uint32_t number : process.callbacks) {
      const double next = callbacks_[number].next.time;
      if (next > start) called = std::min(called, next);
    }
  if (sim_.policy->synchronous() && limit < never) return std::max(called, least);

  // the time to travel window_cells of a cell: v s + a s^2/2 = distance
  const double growth = std::ldexp(1.0, std::max(0, process.lonely_claims - cost::patience));
  const double distance = sim_.options.window_cells * std::max(cell_, 2 * body.radius) * growth;
  double speed = 0, pull = 0, latest = start + cost::longest_window;
  if (path) {
    speed = path->velocity(start).norm();
    pull = path->acceleration.norm();
  } else {
    latest = std::min(latest, trajectory.step_end(start));
    speed = trajectory.bounds(start, latest).speed;
  }
  const double root = std::sqrt(speed * speed + 2 * pull * distance);
  const double end = std::min(latest, start + 2 * distance / std::max(speed + root, 1e-300));
  return std::max(std::min(end, called), least);
}

Aabb Claims::claimed_box(const Body& body, double end) const {
  Aabb box;
  const State* state = sim_.graph.last_at_or_before_time(body.process, sim_.present.gvt);
  if (!state) state = sim_.graph.head(body.process);
  for (; state; state = state->next) {
    const double from = std::max(state->key.time, sim_.present.gvt);
    // records carry the arc on
    while (state->next && !state->next->starts_arc()) state = state->next;
    const double to = state->next ? std::min(state->next->key.time, end) : end;
    if (to < from) continue;
    // checks find the contacts of members with what is so near
    Aabb swept = swept_bounds(body, state->trajectory(), from, to);
    if (state->group && state->trajectory().stepped())
      swept.grow(answer::contact_margin * body.least_width);
    box.add(swept);
  }
  box.grow(cost::box_inflation * (box.lo.cwiseAbs().maxCoeff() + box.hi.cwiseAbs().maxCoeff()));
  return box;
}

void Claims::place_fixed(const Body& body) {
  if (!body.unbounded) sim_.grid.place(body.id(), claimed_box(body, sim_.present.gvt), true);
  placed_[body.id()] = true;
}

// Where the arcs end is found before anybody relies on them.
void Claims::test_group_ends(std::span<const Body* const> bodies) {
  Groups untested;
  for (const Body* body : bodies) {
    const State& tail = *sim_.graph.tail(body->process);
    if (tail.group && !tail.group->found && !tail.group->at_rest) untested.push_back(tail.group);
  }
  if (untested.empty()) return;
  sort_once(untested);
  test_ends(untested);
}

// Decides how far the body claims; false: it claims no further.
bool Claims::begin(const Body& body, Window& window) {
  ++counters_.claims;
  const State& tail = *sim_.graph.tail(body.process);
  Process& process = sim_.process(body);
  if (tail.error || process.claim.time >= tail.arc_end()) {
    // a stopped process moves no further, a member of a group not past the next check
    sim_.queue.withdraw(process.advance);
    // others may have found out already that it cannot be followed
    if (tail.driven() && !tail.error) schedule_group_check(body.process);
    return false;
  }
  window.body = &body;
  window.before = process.claim;
  window.end = body.fixed() ? never : window_end(body);
  if (tail.driven() && body.dynamic()) {
    if (sim_.policy->synchronous()) tail.trajectory().halt(window.end);
    // where it fails it stops: found out before anybody relies on this claim
    static_cast<void>(tail.trajectory().pose(window.end));
    if (tail.arc_end() < never) schedule_group_check(body.process);
    window.end = std::min(window.end, tail.arc_end());
  }
  return true;
}

void Claims::claim_windows(std::span<const Body* const> bodies) {
  test_group_ends(bodies);
  constexpr std::size_t most = 1024;  // at once: what they need beside each other is not little
  for (std::size_t i = 0; i < bodies.size(); i += most)
    claim_some(bodies.subspan(i, std::min(most, bodies.size() - i)));
}

void Claims::claim_some(std::span<const Body* const> bodies) {
  if (windows_.size() < bodies.size()) windows_.resize(bodies.size());
  std::size_t count = 0;
  for (const Body* body : bodies) count += begin(*body, windows_[count]);
  const std::span<Window> windows(windows_.data(), count);
  const auto each_with_shape = [&](std::size_t grain, auto&& work) {
    each_in_parallel(count, grain, [&](std::size_t i) {
      if (windows[i].body->shape_P) work(windows[i]);
    });
  };
  each_with_shape(16, [&](Window& w) {
    if (!w.body->unbounded)
      w.box = claimed_box(*w.body, w.body->fixed() ? sim_.present.gvt : w.end);
  });
  for (const Window& w : windows) {
    const Body& body = *w.body;
    sim_.process(body).claim_to(body.fixed() ? last_key : Key{w.end, 0, KeyKind::birth, 0});
    if (!body.shape_P) continue;
    if (!body.unbounded) sim_.grid.place(body.id(), w.box, body.fixed());
    placed_[body.id()] = true;
  }
  for (const Window& w : windows)
    if (w.body->shape_P) drop_parted_pairs(*w.body);
  each_with_shape(16, [&](Window& w) { find_near(*w.body, w.near); });
  try {
    meet_all(windows);
  } catch (...) {
    // Ctrl-C in a motion's procedure: some may not have been met, so all are claimed anew
    for (const Window& w : windows) {
      sim_.process(*w.body).claim_to(w.before);
      schedule_advance(*w.body);
    }
    throw;
  }
  for (const Window& w : windows) {
    Process& process = sim_.process(*w.body);
    if (w.body->shape_P)
      process.lonely_claims = w.near.empty() ? std::min(process.lonely_claims + 1,
                                                        cost::patience + cost::most_doublings)
                                             : 0;
    schedule_advance(*w.body);
  }
}

void Claims::claim_due(const Event& event) {
  due_.clear();
  due_bodies_.clear();
  if (event.priority == sim_.queue.top_priority()) sim_.queue.first_ones(due_);
  std::erase_if(due_, [](const Event& e) { return e.kind != EventKind::advance; });
  if (due_.empty()) due_.push_back(event);
  std::sort(due_.begin(), due_.end(),
            [](const Event& x, const Event& y) { return x.subject < y.subject; });
  for (const Event& e : due_) due_bodies_.push_back(&sim_.body(e.subject));
  claim_windows(due_bodies_);
}

bool Claims::boxes_overlap(const Body& a, const Body& b) const {
  if (a.unbounded && b.unbounded) return true;
  if (a.unbounded || b.unbounded) {
    const Body& plane = a.unbounded ? a : b;
    const Body& other = a.unbounded ? b : a;
    return !plane.is_fixed_plane || plane_overlaps(plane, sim_.grid.box(other.id()));
  }
  return sim_.grid.box(a.id()).overlaps(sim_.grid.box(b.id()));
}

// Both boxes now reach from GVT to the lesser claim; disjoint boxes mean: free until then.
void Claims::drop_parted_pairs(const Body& body) {
  for (std::size_t i = pairs_.of(body.id()).size(); i-- > 0;) {
    const std::uint32_t index = pairs_.of(body.id())[i];
    const Pair& pair = pairs_[index];
    if (!pair.pending && !boxes_overlap(sim_.body(pair.a), sim_.body(pair.b))) pairs_.drop(index);
  }
}

// All others that may be met where the body's box is.
void Claims::find_near(const Body& body, std::vector<BodyId>& near) const {
  near.clear();
  const auto consider = [&](BodyId id) {
    const Body& other = sim_.body(id);
    if (!body.dynamic() && !other.dynamic()) return;
    if (!sim_.scene.may_disable() || sim_.scene.may_collide(body, other)) near.push_back(id);
  };
  if (body.unbounded) {
    for (const auto& other : sim_.scene.bodies)
      if (placed(other->id()) && other->id() != body.id() && boxes_overlap(body, *other))
        consider(other->id());
    return;
  }
  sim_.grid.overlapping(body.id(), consider);
  const Aabb& box = sim_.grid.box(body.id());
  for (const BodyId id : sim_.unbounded) {
    const Body& other = sim_.body(id);
    if (placed(id) && (!other.is_fixed_plane || plane_overlaps(other, box))) consider(id);
  }
}

// Each pair once: of two that both claim, from the first.
void Claims::meet_all(std::span<const Window> windows) {
  place_in_windows_.resize(sim_.scene.bodies.size(), 0);
  for (std::size_t i = 0; i < windows.size(); ++i) place_in_windows_[windows[i].body->id()] = i + 1;
  meetings_.clear();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const Window& w = windows[i];
    if (!w.body->shape_P) continue;
    counters_.candidates += w.near.size();
    for (const BodyId other : w.near) {
      const std::size_t theirs = place_in_windows_[other];
      if (theirs > 0 && theirs <= i) continue;
      const Key& known =
          theirs > 0 ? windows[theirs - 1].before : sim_.process(sim_.body(other)).claim;
      meetings_.push_back({w.body->id(), other, std::min(w.before, known), 0, false, {}, {}});
    }
  }
  for (const Window& w : windows) place_in_windows_[w.body->id()] = 0;
  checks_.meet(meetings_);
}

// Typical spacing of moving bodies: (volume / number)^(1/3), at least their size.
void Claims::measure_spacing() {
  Aabb space;
  double radii = 0;
  int count = 0;
  for (const auto& body : sim_.scene.bodies) {
    if (!body->dynamic() || !body->shape_P) continue;
    space.add(point_at(sim_, body->id(), sim_.present.time).x);
    radii += body->radius;
    ++count;
  }
  if (count == 0) return;
  const double width = 2 * radii / count;
  const Vec3 extent = space.size().cwiseMax(Vec3::Constant(width));
  cell_ = std::max(width, std::cbrt(extent.prod() / count));
}

}  // namespace tw
