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
      : kernel_(kernel),
        cpu_(thread_cpu_seconds()),
        output_(kernel.present.counters.output_cpu_seconds) {
    kernel_.running = true;
  }
  ~RunGuard() {
    kernel_.running = false;
    const double output = kernel_.present.counters.output_cpu_seconds - output_;
    kernel_.present.counters.cpu_seconds += thread_cpu_seconds() - cpu_ - output;
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

void Kernel::process_next() {
  const Event event = policy->next(queue);
  Progress progress = Progress::done;
  switch (event.kind) {
    case EventKind::advance: claim_window(*scene.bodies[event.subject]); break;
    case EventKind::callback: progress = process_callback(event.subject); break;
    case EventKind::group_check: progress = check_group(ProcessId{event.subject}); break;
    case EventKind::pair:
      if (pairs[event.subject].pending)
        progress = process_impact(event.subject);
      else
        pursue(event.subject);
      break;
  }
  if (progress == Progress::try_again) ++present.counters.events_postponed;
  ++present.counters.events;
  present.counters.pair_sum += static_cast<double>(live_pairs_);
  ++events_since_gvt_;
  if (options.check) validate_all();
}

// GVT and commit cost busy processes + pairs; often enough to keep queues and boxes short, rarely
// enough to be cheap.
bool Kernel::gvt_is_due() const {
  if (options.gvt_interval > 0) return events_since_gvt_ >= options.gvt_interval;
  const std::size_t scanned = graph.busy().size() + live_pairs_;
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
  if (until < present.time) return RunStatus::finished;
  const RunGuard guard(*this);
  until_ = until;
  begin_run();

  slice_end_ = slice < never ? wall_seconds() + slice : never;
  if (!deliver(slice_end_)) return RunStatus::slice_over;
  long events = 0;
  while (!finished()) {
    process_next();
    if (gvt_is_due()) update_gvt();
    if (slice < never && (++events & 7) == 0 && wall_seconds() > slice_end_)
      return RunStatus::slice_over;
  }
  update_gvt();
  present.time = until;
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
  process_next();
  update_gvt();
  deliver(never);
  return true;
}

const State* Kernel::state_at(BodyId id, double when) const {
  // between runs nothing but the past counts
  const State* state = when == present.time && !running
                           ? graph.last_before(process_of(id), present.key())
                           : graph.last_at_or_before_time(process_of(id), when);
  while (state && state->error && state->prev) state = state->prev;
  return state ? state : graph.head(process_of(id));
}

PoseTwist Kernel::point_at(BodyId id, double when) const {
  return evaluate(*scene.bodies[id], *state_at(id, when), when);
}

StateOf Kernel::states_at(double when) const {
  return [this, when](BodyId id) -> const State& { return *state_at(id, when); };
}

double Kernel::total_energy(double when) const {
  double energy = 0;
  for (const auto& body : scene.bodies) {
    if (!body->dynamic()) continue;
    const PoseTwist p = point_at(body->id(), when);
    energy += kinetic_energy(*body, p) - body->mass * present.settings.gravity.dot(p.x);
  }
  return energy + elastic_energy(scene, states_at(when), when);
}

ContactSurvey Kernel::survey_contacts(double when) const {
  return tw::survey_contacts(scene, states_at(when), when);
}

// Nothing is computed in worlds without kinematic bodies.
double Kernel::kinematic_work_of(const State& state, double until) const {
  return kinematic.empty() ? 0 : contact_work(scene, state, until);
}

Vec3 Kernel::total_momentum(double when) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& body : scene.bodies)
    if (body->dynamic()) sum += body->mass * point_at(body->id(), when).v;
  return sum;
}

}  // namespace tw
