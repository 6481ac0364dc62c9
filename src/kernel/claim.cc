// Claims: how far a body's swept box reaches, and whom it may meet there.
//
// A body claims its motion window by window.  Its box then covers the *continuous* motion from GVT
// to the claimed time; a box that comes to overlap another makes the pair active, and the pair is
// looked at from the lesser claimed time before this claim, which may lie in the past of one of
// them (the paper, section 4.5 and figure 5).
//
// Cost: one insertion into the spatial hash and one query a window.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {
namespace {

// Boxes are grown by this share of their coordinates: rounding in arcs must not part what touches.
constexpr double box_inflation = 1e-9;

// A body that claims and finds nobody several times in a row claims longer windows, each twice the
// one before.  In a gas a single lonely claim says little, and long boxes are looked at by many.
constexpr int patience = 3;
constexpr int most_doublings = 20;

// The longest window, s: a body that hardly moves need not claim again for long.
constexpr double longest_window = 8;

// Solid half-space n.x <= offset against a box: its lowest corner along n.
bool plane_overlaps(const Body& plane, const Aabb& box) {
  const Vec3& n = plane.plane_normal;
  double lowest = 0;
  for (int i = 0; i < 3; ++i) lowest += std::min(n[i] * box.lo[i], n[i] * box.hi[i]);
  return lowest <= plane.plane_offset;
}

}  // namespace

void Kernel::schedule_advance(Body& body) {
  // a member waits for the group check where its arc ends
  if (body.fixed() || process(body).claim.time >= graph.tail(body.process)->trajectory().end()) {
    queue.withdraw(process(body).advance);
    return;
  }
  // after callbacks of that instant, which may start a new arc, and before its impacts
  const Key key{process(body).claim.time, 0, KeyKind::group_check, body.id()};
  queue.schedule(process(body).advance,
                 make_event(key, EventKind::advance, body.id(), process(body).head_start));
}

bool Kernel::ready(const Body& body, const Key& key) const {
  return body.fixed() || key < process(body).claim;
}

// Claims windows until `key` lies before the claim.
void Kernel::make_ready(Body& body, const Key& key) {
  while (!ready(body, key) && !graph.tail(body.process)->error &&
         process(body).claim.time < graph.tail(body.process)->trajectory().end())
    claim_window(body);
}

double Kernel::window_end(const Body& body) const {
  const State& tail = *graph.tail(body.process);
  const double start = process(body).claim.time;
  const Trajectory& trajectory = tail.trajectory();
  const Parabola* path = trajectory.ballistic();
  if (!path && !body.kinematic()) return trajectory.end();

  // the time to travel window_cells of a cell: v s + a s^2/2 = distance
  const double growth = std::ldexp(1.0, std::max(0, process(body).lonely_claims - patience));
  const double distance = options.window_cells * std::max(cell_, 2 * body.radius) * growth;
  double speed = 0, pull = 0;
  if (path) {
    speed = path->velocity(start).norm();
    pull = path->acceleration.norm();
  } else {
    speed = trajectory.bounds(start, start + longest_window).speed;
  }
  const double root = std::sqrt(speed * speed + 2 * pull * distance);
  double end = start + std::min(longest_window, 2 * distance / std::max(speed + root, 1e-300));

  // the next callback ends the arc as we know it
  for (const std::uint32_t number : process(body).callbacks) {
    const double next = callbacks[number].next.time;
    if (next > start) end = std::min(end, next);
  }
  return std::max(end, std::nextafter(start, never));
}

Aabb Kernel::claimed_box(const Body& body, double end) const {
  Aabb box;
  const State* state = graph.last_at_or_before_time(body.process, gvt);
  if (!state) state = graph.head(body.process);
  for (; state; state = state->next) {
    const double from = std::max(state->key.time, gvt);
    const double to = state->next ? std::min(state->next->key.time, end) : end;
    if (to >= from) box.add(swept_bounds(body, state->trajectory(), from, to));
  }
  if (const State& tail = *graph.tail(body.process); tail.trajectory().stepped())
    box.grow(contact_margin * body.least_width);
  box.grow(box_inflation * (box.lo.cwiseAbs().maxCoeff() + box.hi.cwiseAbs().maxCoeff()));
  return box;
}

void Kernel::claim_window(Body& body) {
  ++counters.claims;
  if (const auto& group = graph.tail(body.process)->group; group && !group->end_tested) {
    test_group_end(*group);
    schedule_group_checks(*group);
  }
  const Key before = process(body).claim;
  if (graph.tail(body.process)->error ||
      process(body).claim.time >= graph.tail(body.process)->trajectory().end()) {
    // a stopped process moves no further, a member of a group not past the next check
    queue.withdraw(process(body).advance);
    return;
  }

  const double end = body.fixed() ? never : window_end(body);
  process(body).claim = body.fixed() ? last_key : Key{end, 0, KeyKind::birth, 0};
  if (body.shape_P) {
    if (!body.unbounded)
      grid.place(body.id(), claimed_box(body, body.fixed() ? gvt : end), body.fixed());
    body.placed = true;
    drop_parted_pairs(body);
    const std::uint64_t candidates = counters.candidates;
    find_partners(body, before);
    const bool alone = counters.candidates == candidates;
    process(body).lonely_claims =
        alone ? std::min(process(body).lonely_claims + 1, patience + most_doublings) : 0;
  }
  schedule_advance(body);
}

bool Kernel::boxes_overlap(const Body& a, const Body& b) const {
  if (a.unbounded && b.unbounded) return true;
  if (a.unbounded || b.unbounded) {
    const Body& plane = a.unbounded ? a : b;
    const Body& other = a.unbounded ? b : a;
    return !plane.is_fixed_plane || plane_overlaps(plane, grid.box(other.id()));
  }
  return grid.box(a.id()).overlaps(grid.box(b.id()));
}

bool Kernel::may_collide(const Body& a, const Body& b) const {
  return !a.info.removed && !b.info.removed && contact_parameters(a.id(), b.id()).collide;
}

// Both boxes now reach from GVT to the lesser claim; disjoint boxes mean: free until then.
void Kernel::drop_parted_pairs(Body& body) {
  for (std::size_t i = body.pairs.size(); i-- > 0;) {
    const std::uint32_t index = body.pairs[i];
    const Pair& pair = pairs[index];
    if (!pair.pending && !boxes_overlap(*bodies[pair.a], *bodies[pair.b])) drop_pair(index);
  }
}

void Kernel::find_partners(Body& body, const Key& claimed_before) {
  const auto consider = [&](BodyId id) {
    ++counters.candidates;
    Body& other = *bodies[id];
    if (body.dynamic() || other.dynamic()) meet(body, other, claimed_before);
  };
  if (body.unbounded) {
    for (const auto& other : bodies)
      if (other->placed && other->id() != body.id() && boxes_overlap(body, *other))
        consider(other->id());
    return;
  }
  grid.overlapping(body.id(), consider);
  const Aabb& box = grid.box(body.id());
  for (const BodyId id : unbounded) {
    const Body& other = *bodies[id];
    if (other.placed && (!other.is_fixed_plane || plane_overlaps(other, box))) consider(id);
  }
}

void Kernel::meet(Body& body, Body& other, const Key& claimed_before) {
  if (contacts_may_disable_ && !may_collide(body, other)) return;
  if (const std::uint32_t known = find_pair(body, other); known != no_pair) {
    const Pair& pair = pairs[known];
    const bool waits = pair.event == EventQueue::none && !pair.pending && !pair.parked;
    if (waits && pair.from != last_key) pursue(known);
    return;
  }
  const Key from = std::min(claimed_before, process(other).claim);
  if (in_contact_from(std::min(body.id(), other.id()), std::max(body.id(), other.id()), from))
    return;

  // an exact pair gets a record only when it will meet
  bool all_exact = true;
  const auto impact = first_exact_impact(body, other, from, all_exact);
  if (all_exact && !impact) return;
  const std::uint32_t index = make_pair(body, other, from);
  if (all_exact)
    set_pending(index, *impact);
  else
    pursue(index);
}

}  // namespace tw
