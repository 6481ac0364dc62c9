// The main loop: least key first, GVT every so often, until everything up to the end is committed.
//
// What comes next is the policy's choice (policy.h).
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/kernel.h"

#include <algorithm>
#include <cmath>

#include "base/cpu-clock.h"
#include "kernel/check/validate.h"
#include "kernel/loop/run-guard.h"
#include "kernel/report/reading.h"

namespace tw {

// ---- between runs ----

std::uint64_t Kernel::add_callback(const CallbackDef& def) {
  simulation.require_between_runs("a callback was added");
  callbacks.require_possible(def);
  if (simulation.present.begun) discontinuities.restart_future();
  return callbacks.add(def);
}

void Kernel::add_collision_callback(const CollisionCallbackDef& def) {
  simulation.require_between_runs("a collision callback was added");
  impacts.add_callback(def);
  if (simulation.present.begun) discontinuities.restart_future();
}

void Kernel::remove_callback(const Callback* callback) {
  simulation.require_between_runs("a callback was removed");
  TW_REQUIRE(callbacks.end(callback),
             "the callback is not called any more; expected one that was "
             "not removed, nor restored away");
  if (simulation.present.begun) discontinuities.restart_future();
}

void Kernel::remove_callback(const CollisionCallback* callback) {
  simulation.require_between_runs("a collision callback was removed");
  TW_REQUIRE(impacts.remove(callback),
             "the callback is not called any more; expected one that was "
             "not removed, nor restored away");
  if (simulation.present.begun) discontinuities.restart_future();
}

CollisionObserverPtr Kernel::add_collision_observer(CollisionObserver observer, CollisionKind kind,
                                                    Watch watch) {
  simulation.require_between_runs("an observer was added");
  if (simulation.present.begun && !delivery.observed(kind)) discontinuities.restart_future();
  return delivery.add_observer(std::move(observer), kind, watch);
}

void Kernel::remove_observer(const CollisionObserver* observer) {
  simulation.require_between_runs("an observer was removed");
  TW_REQUIRE(delivery.remove_observer(observer),
             "the observer looks no more; expected one that was "
             "not removed, nor restored away");
}

void Kernel::add_frame_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch) {
  simulation.require_between_runs("a frame sink was added");
  delivery.add_sink(std::move(sink), fps, watch);
}

// Where who was placed elsewhere overlaps another, it is back where it was.
void Kernel::edit(BodyId id, const std::function<void(StateView&)>& change) {
  const Editing::Edited edited = editing.edit(id, change);
  if (!simulation.present.begun || edited.placed.empty()) return;
  const PlacedTogether together = simulation.present.together;
  try {
    for (const BodyId placed : edited.placed) {
      simulation.present.together.forget(placed);
      bodies.check_overlaps(simulation.body(placed));
    }
  } catch (...) {
    editing.take_back(edited);
    simulation.present.together = together;
    for (const BodyId placed : edited.placed) claims.forget_box(placed);
    throw;
  }
}

// ---- the loop ----

Progress Kernel::process(const Event& event) {
  switch (event.kind) {
    case EventKind::advance:
      // at those that are known already, and at those that were found
      impacts.look_ahead(event);
      claims.claim_due(event);
      impacts.look_ahead(event);
      break;
    case EventKind::callback: return callback_events.process(event.subject);
    case EventKind::group_check: return groups.check(ProcessId{event.subject});
    case EventKind::pair:
      if (pairs[event.subject].pending) return impacts.process(event.subject);
      checks.pursue(event.subject);
      break;
  }
  return Progress::done;
}

void Kernel::process_next() { take(Event(simulation.policy->next(simulation.queue))); }

void Kernel::take(const Event& event) {
  Counters& counters = simulation.present.counters;
  const std::uint64_t claims_before = counters.claims;
  if (process(event) == Progress::try_again) ++counters.events_postponed;
  ++counters.events;
  counters.pair_sum += static_cast<double>(pairs.live());
  // one event may claim for many
  commit.note_events(std::max<std::uint64_t>(1, counters.claims - claims_before));
  if (simulation.options.check) validate_all();
}

// Those that came since the last run claim first; what stopped somebody is tried again.
void Kernel::begin_run() {
  discontinuities.retry_errors();
  Present& present = simulation.present;
  if (bodies.any_newborn()) {
    claims.measure_spacing();
    bodies.check_newborn();
    if (!present.begun && simulation.options.adversary) {
      simulation.adversary.begin(*simulation.options.adversary);
      simulation.adversary.choose(simulation.processes);
      callbacks.take_head_starts();
    }
    present.begun = true;
    bodies.claim_newborn();
  }
  present.begun = true;
  bodies.meet_overlapping();
  if (!present.counters.energy_known) {
    present.counters.energy_start = total_energy(simulation, present.time);
    present.counters.energy_known = true;
  }
}

namespace {

// Between runs anything may change: what was decided ahead holds no longer.
class ForgetAtEnd {
 public:
  ForgetAtEnd(GroupEvents& groups, ImpactEvents& impacts) : groups_(groups), impacts_(impacts) {}
  ~ForgetAtEnd() {
    groups_.forget_decisions();
    impacts_.forget_decisions();
  }
  ForgetAtEnd(const ForgetAtEnd&) = delete;
  ForgetAtEnd& operator=(const ForgetAtEnd&) = delete;

 private:
  GroupEvents& groups_;
  ImpactEvents& impacts_;
};

}  // namespace

RunStatus Kernel::advance(double until, double slice) {
  TW_REQUIRE(std::isfinite(until),
             "time to run to is " + show(until) + "; expected a finite number of seconds");
  TW_REQUIRE(!simulation.running,
             "a run was started inside a callback or observer; expected to be between runs");
  if (until < simulation.present.time) return RunStatus::finished;
  const RunGuard guard(simulation);
  const ForgetAtEnd forget(groups, impacts);
  begin_run();

  const double wall_end = slice < never ? wall_seconds() + slice : never;
  commit.begin_run(until, wall_end);
  if (!delivery.deliver(wall_end)) return RunStatus::slice_over;
  long events = 0;
  while (!commit.finished()) {
    process_next();
    if (commit.gvt_is_due()) commit.update_gvt();
    if (slice < never && (++events & 7) == 0 && !groups.amid_decisions() &&
        wall_seconds() > wall_end)
      return RunStatus::slice_over;
  }
  commit.update_gvt();
  simulation.present.time = until;
  return delivery.deliver(wall_end) ? RunStatus::finished : RunStatus::slice_over;
}

StepReport Kernel::describe(const Event& event) const {
  const double time = event.key.time;
  switch (event.kind) {
    case EventKind::advance: return {"advance", time, {BodyId{event.subject}}};
    case EventKind::callback: return {"callback", time, callbacks[event.subject].def.targets};
    case EventKind::group_check:
      return {"group-check", time, simulation.processes[event.subject].bodies};
    case EventKind::pair: break;
  }
  const Pair& pair = pairs[event.subject];
  return {pair.pending ? "impact" : "check", time, {BodyId{pair.a}, BodyId{pair.b}}};
}

std::optional<StepReport> Kernel::step(double until) {
  TW_REQUIRE(!simulation.running,
             "a step was made inside a callback or observer; expected to be between runs");
  const RunGuard guard(simulation);
  const ForgetAtEnd forget(groups, impacts);
  begin_run();
  commit.begin_run(until, never);
  if (commit.finished()) return std::nullopt;
  const Event event = simulation.policy->next(simulation.queue);
  const StepReport report = describe(event);
  take(event);
  commit.update_gvt();
  delivery.deliver(never);
  return report;
}

// ---- looking ----

std::vector<DearestGroup> Kernel::dearest_groups() const { return dearest_groups_of(simulation); }

StatisticsTable Kernel::statistics() const {
  return statistics_of(simulation, delivery, work_count.since(before_));
}

void Kernel::validate_all() const {
  for (const auto& broken :
       {validate_state_graph(simulation), validate_event_queue(simulation, pairs, callbacks),
        validate_pairs(simulation, pairs), validate_residences(simulation),
        validate_claims(simulation, claims)})
    TW_ASSERT(broken.empty(), broken + " (GVT " + show(simulation.present.gvt) + " s)");
}

}  // namespace tw
