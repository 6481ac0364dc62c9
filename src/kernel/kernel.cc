// The main loop: least key first, GVT every so often, until everything up to the end is committed.
//
// What comes next is the policy's choice (policy.h).  The adversary scheduler gives events or
// bodies a random head start: they are taken out of order, which makes rollbacks common; the
// committed history must not change.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/kernel.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/cpu-clock.h"

namespace tw {
namespace {

// Marks the kernel as running, and adds up its CPU time, delivery to sinks excluded.
class RunGuard {
 public:
  explicit RunGuard(Kernel& kernel)
      : kernel_(kernel), cpu_(thread_cpu_seconds()), output_(kernel.counters.output_cpu_seconds) {
    kernel_.running = true;
  }
  ~RunGuard() {
    kernel_.running = false;
    const double output = kernel_.counters.output_cpu_seconds - output_;
    kernel_.counters.cpu_seconds += thread_cpu_seconds() - cpu_ - output;
  }
  RunGuard(const RunGuard&) = delete;
  RunGuard& operator=(const RunGuard&) = delete;

 private:
  Kernel& kernel_;
  double cpu_, output_;
};

}  // namespace

Kernel::Kernel() = default;

Event Kernel::make_event(const Key& key, EventKind kind, std::uint32_t subject, double head_start) {
  double priority = key.time - head_start;
  if (options.adversary && options.adversary->every_event)
    priority -= options.adversary->head_start * adversary_.real();
  return {priority, key, kind, subject};
}

void Kernel::handle(Event event) {
  switch (event.kind) {
    case EventKind::advance: claim_window(*bodies[event.subject]); break;
    case EventKind::callback: process_callback(event.subject); break;
    case EventKind::group_check: process_group_check(event.subject); break;
    case EventKind::pair:
      if (pairs[event.subject].pending)
        process_impact(event.subject);
      else
        pursue(event.subject);
      break;
  }
  ++counters.events;
  counters.pair_sum += static_cast<double>(counters.live_pairs);
  ++events_since_gvt_;
  if (options.check) validate_all();
}

// GVT and commit cost busy processes + pairs; often enough to keep queues and boxes short, rarely
// enough to be cheap.
bool Kernel::gvt_is_due() const {
  if (options.gvt_interval > 0) return events_since_gvt_ >= options.gvt_interval;
  const std::size_t scanned = graph.busy().size() + counters.live_pairs;
  return events_since_gvt_ >= static_cast<long>(std::max<std::size_t>(64, scanned / 4));
}

// Everything up to the end is final when nothing that could still change it is left.
bool Kernel::finished() {
  if (queue.empty() || queue.top_priority() > until_) {
    if (compute_gvt() > until_) return true;
  }
  return queue.empty();
}

RunStatus Kernel::advance(double until, double slice) {
  TW_REQUIRE(std::isfinite(until),
             "time to run to is " + show(until) + "; expected a finite number of seconds");
  TW_REQUIRE(!running,
             "a run was started inside a callback or observer; expected to be between runs");
  if (until < time) return RunStatus::finished;
  const RunGuard guard(*this);
  until_ = until;
  begin_run();

  slice_end_ = slice < never ? wall_seconds() + slice : never;
  if (!deliver(slice_end_)) return RunStatus::slice_over;
  long events = 0;
  while (!finished()) {
    policy->go_forward(*this);
    if (gvt_is_due()) update_gvt();
    if (slice < never && (++events & 7) == 0 && wall_seconds() > slice_end_)
      return RunStatus::slice_over;
  }
  update_gvt();
  time = until;
  return deliver(slice_end_) ? RunStatus::finished : RunStatus::slice_over;
}

void Kernel::deliver_rest() {
  const RunGuard guard(*this);
  deliver(never);
}

bool Kernel::step(double until) {
  TW_REQUIRE(!running,
             "a step was made inside a callback or observer; expected to be between runs");
  const RunGuard guard(*this);
  until_ = until;
  begin_run();
  if (finished()) return false;
  policy->go_forward(*this);
  update_gvt();
  deliver(never);
  return true;
}

const State* Kernel::state_at(BodyId id, double when) const {
  // between runs nothing but the past counts
  const State* state = when == time && !running
                           ? graph.last_before(process_of(id), present_key())
                           : graph.last_at_or_before_time(process_of(id), when);
  while (state && state->error && state->prev) state = state->prev;
  return state ? state : graph.head(process_of(id));
}

PoseTwist Kernel::point_at(BodyId id, double when) const {
  return state_at(id, when)->trajectory().at(when);
}

double Kernel::total_energy(double when) const {
  double energy = 0;
  const auto by_key = [](const Group* x, const Group* y) {
    return x->key < y->key || (x->key == y->key && x->members < y->members);
  };
  std::set<const Group*, decltype(by_key)> groups(by_key);
  for (const auto& body : bodies) {
    if (!body->dynamic()) continue;
    const PoseTwist p = point_at(body->id(), when);
    energy += kinetic_energy(*body, p) - body->mass * options.gravity.dot(p.x);
    const State* state = state_at(body->id(), when);
    if (state->group) groups.insert(state->group.get());
  }
  // the springs of a link in the group that has the say in it
  for (const Group* group : groups) {
    std::vector<bool> counted(group->tags.size(), false);
    for (const ContactPair& pair : group->pairs) {
      const State* a = state_at(first_of(pair.id), when);
      const State* b = state_at(second_of(pair.id), when);
      if (owner_of(*a, *b) != group) continue;
      std::fill_n(counted.begin() + pair.first, pair.count, true);
    }
    energy += group->arc->elastic_energy(group->at_rest ? group->key.time : when, counted);
  }
  return energy;
}

Vec3 Kernel::total_momentum(double when) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& body : bodies)
    if (body->dynamic()) sum += body->mass * point_at(body->id(), when).v;
  return sum;
}

}  // namespace tw
