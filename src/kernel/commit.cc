// GVT and commit: what lies before GVT is final.
//
// GVT is the least of every pair's safe time, every other pending event's time and every moving
// process's claimed time.  At commit states enter the hash, collisions reach observers and frames
// their sinks, all in time order and once; then states nobody can ask for are freed.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/cpu-clock.h"
#include "base/hash.h"
#include "kernel/kernel.h"

namespace tw {

std::uint64_t state_hash(const Body& body, const Key& key, const PoseTwist& point,
                         const StateData& data) {
  const BodyState s = body_state(body, point);
  Hasher h;
  h.add(std::uint64_t{body.id()});
  h.add(key.time);
  h.add(std::uint64_t{key.microstep});
  h.add(kind_code(key.kind));
  h.add(key.id);
  for (int i = 0; i < 3; ++i) h.add(s.position[i]);
  for (int i = 0; i < 4; ++i) h.add(s.orientation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) h.add(s.velocity[i]);
  for (int i = 0; i < 3; ++i) h.add(s.angular_velocity[i]);
  if (data.slots) h.add(data.slots->hash());
  return h.value();
}

// Claims, callbacks and known impacts are events at their own time; a pair that is followed on the
// grid is safe only up to its last check, before its event.
double Kernel::compute_gvt() const {
  double least = queue.least_time();
  for (const Pair& pair : pairs)
    if (pair.live && !pair.parked) least = std::min(least, pair.safe_time());
  return least;
}

// Moves GVT up and commits what it passes, but nothing later than the run's end.
void Kernel::update_gvt() {
  ++counters.gvt_computations;
  events_since_gvt_ = 0;
  const double least = compute_gvt();
  TW_ASSERT(least >= gvt, "GVT would fall from " + show(gvt) + " to " + show(least));
  const bool inclusive = least > until_;
  const double limit = std::min(least, until_);
  if (limit == never) return;  // nothing moves and nothing is asked for
  if (limit > gvt || inclusive) commit(limit, inclusive);
}

// Everything before `limit` (at it, too, if inclusive) is final.  What is committed is so before
// observers hear of it: an error of theirs leaves the world at its last committed time.
void Kernel::commit(double limit, bool inclusive) {
  const std::exception_ptr error = error_before(limit, inclusive);
  commit_states(limit, inclusive);
  gvt = time = limit;
  due_ = {limit, inclusive};
  if (error)
    deliver(never);
  else if (delivery_is_worth_it())
    deliver(slice_end_);
  free_states(limit);
  if (error) std::rethrow_exception(error);
}

// The error of the first stopped process that GVT passes, null if there is none: then the commit
// ends where it stopped.
std::exception_ptr Kernel::error_before(double& limit, bool& inclusive) const {
  const State* first = nullptr;
  for (const ProcessId process : graph.busy()) {
    const State* tail = graph.tail(process);
    if (!tail || !tail->error) continue;
    if (tail->key.time < limit || (inclusive && tail->key.time == limit))
      if (!first || tail->key < first->key) first = tail;
  }
  if (!first) return nullptr;
  limit = first->key.time;
  inclusive = false;
  return first->error;
}

void Kernel::commit_states(double limit, bool inclusive) {
  const auto passed = [&](const State* s) {
    return s->key.time < limit || (inclusive && s->key.time == limit);
  };
  const std::size_t delivered_before = undelivered_.size();
  for (const ProcessId process : graph.busy()) {
    // back from the tail to the last committed one, then forward
    State* state = graph.tail(process);
    while (state && state->prev && !state->prev->committed) state = state->prev;
    if (!state || state->committed) continue;
    for (; state && passed(state) && !state->error; state = state->next) commit_state(*state);
  }
  // what one discontinuity tells has one key: in the order told
  std::stable_sort(undelivered_.begin() + static_cast<std::ptrdiff_t>(delivered_before),
                   undelivered_.end(),
                   [](const auto& x, const auto& y) { return x->key < y->key; });
}

void Kernel::commit_state(State& state) {
  state.committed = true;
  counters.kinematic_work += state.tally.kinematic_work;
  counters.max_penetration = std::max(counters.max_penetration, state.tally.depth);
  // each ring is counted by its member with the least id
  const bool impact = state.key.kind == KeyKind::impact;
  const bool call = state.key.kind == KeyKind::callback && state.changed;
  bool first = impact || call;
  for (const State* r = state.ring; first && r != &state; r = r->ring)
    first = state.process < r->process;
  if (first && impact) ++counters.collisions;
  if (first && call) ++counters.callback_changes;
  if (state.key.kind == KeyKind::callback)
    callbacks[state.key.id].committed_next = state.next_callback;
  counters.fusions += state.tally.fusions;
  counters.collisions -= state.tally.fusions;  // their keys are those of impacts
  counters.fissions += state.tally.fissions;
  counters.contact_changes += state.tally.contact_changes;
  if (state.report && !observers.empty())
    for (const Collision& report : *state.report) undelivered_.emplace_back(state.report, &report);
  if (options.hash && state.changed) {
    const Body& body = body_of(state.process);
    hash_sum_ += state_hash(body, state.key, state.trajectory().at(state.key.time), state);
    ++hash_count_;
  }
}

// Writing frames drives the stepping loop's data out of the processor's caches, so they go in
// batches: at the latest when the next slice begins or the run ends.
bool Kernel::delivery_is_worth_it() const {
  constexpr std::size_t batch = 512, most_waiting_states = 20000;
  if (undelivered_.size() >= 8 * batch) return true;
  // states wait for their frames: memory
  if (graph.state_count() >= most_waiting_states) return true;
  return std::any_of(sinks.begin(), sinks.end(), [&](const SinkRecord& s) {
    return (due_.time - s.next_time()) * s.fps >= batch;
  });
}

// Collisions and frames in time order; a collision at a frame's time comes first.  Each observer
// hears of a collision once, whatever another one or a call before did: what an error keeps from
// being delivered is delivered by the next call, and a call delivers one thing at least.
bool Kernel::deliver(double wall_end) {
  const double cpu = thread_cpu_seconds();
  struct AddTime {
    Kernel& kernel;
    double start;
    ~AddTime() { kernel.counters.output_cpu_seconds += thread_cpu_seconds() - start; }
  } add_time{*this, cpu};

  do {
    SinkRecord* sink = nullptr;
    for (SinkRecord& s : sinks)
      if (!sink || s.next_time() < sink->next_time()) sink = &s;
    const bool frame_due = sink && due_.reaches(sink->next_time());
    if (!undelivered_.empty() && (!frame_due || undelivered_.front()->time <= sink->next_time())) {
      const std::shared_ptr<const Collision> collision = undelivered_.front();
      while (next_observer_ < observers.size()) {
        const ObserverRecord& record = observers[next_observer_++];
        if (record.kind == collision->kind) record.observer(*collision);
      }
      undelivered_.pop_front();
      next_observer_ = 0;
      continue;
    }
    if (!frame_due) return true;
    deliver_frame(*sink);
  } while (wall_end == never || wall_seconds() < wall_end);
  return false;
}

void Kernel::deliver_frame(SinkRecord& record) {
  const double frame_time = record.next_time();
  const long index = record.next_frame++;
  std::vector<BodyPose> poses;
  for (const auto& body : bodies) {
    if (body->fixed()) continue;
    const State* state = graph.last_at_or_before_time(body->process, frame_time);
    if (!state) continue;
    poses.push_back({body->id(), body_state(*body, state->trajectory().at(frame_time))});
  }
  counters.max_penetration = std::max(counters.max_penetration, deepest_contact(frame_time));
  const std::shared_ptr<FrameSink> sink = record.sink;
  sink->frame(index, frame_time, poses);
}

// Keeps the last state at or before the limit, and what frames that are still due will read.
void Kernel::free_states(double limit) {
  for (const SinkRecord& sink : sinks) limit = std::min(limit, sink.next_time());
  for (const ProcessId process : graph.busy()) {
    State* keep = graph.last_at_or_before_time(process, limit);
    // ties: an edit at the limit may follow the first of several states there
    while (keep && !keep->committed) keep = keep->prev;
    if (keep) graph.free_before(keep, release());
  }
  graph.tidy_busy();
}

std::string Kernel::history_hash() const {
  std::uint64_t sum = hash_sum_;
  for (const auto& body : bodies) {
    if (body->info.removed) continue;
    const State* state = state_at(body->id(), time);
    const Key end{time, 0, KeyKind::step, body->id()};
    sum += state_hash(*body, end, state->trajectory().at(time), *state);
  }
  std::string bytes;
  for (const std::uint64_t word : {sum, hash_count_})
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i) & 0xff);
  return sha256_hex(bytes);
}

}  // namespace tw
