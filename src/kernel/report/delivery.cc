// Delivery of what is committed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/report/delivery.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/cpu-clock.h"
#include "base/limits.h"
#include "groups/told/contact-survey.h"
#include "kernel/loop/simulation.h"
#include "kernel/report/reading.h"
#include "timeline/swept-bounds.h"

namespace tw {

CollisionObserverPtr Delivery::add_observer(CollisionObserver observer, CollisionKind kind,
                                            Watch watch) {
  auto shared = std::make_shared<const CollisionObserver>(std::move(observer));
  observers_.push_back({shared, kind, watch});
  return shared;
}

bool Delivery::remove_observer(const CollisionObserver* observer) {
  for (std::size_t i = 0; i < observers_.size(); ++i) {
    if (observers_[i].observer.get() != observer) continue;
    observers_.erase(observers_.begin() + static_cast<std::ptrdiff_t>(i));
    if (i < next_observer_) --next_observer_;
    return true;
  }
  return false;
}

bool Delivery::has(const CollisionObserver* observer) const {
  return std::any_of(observers_.begin(), observers_.end(),
                     [&](const Observer& record) { return record.observer.get() == observer; });
}

bool Delivery::has(const FrameSink* sink) const {
  return std::any_of(sinks_.begin(), sinks_.end(),
                     [&](const Sink& record) { return record.sink.get() == sink; });
}

bool Delivery::observed(CollisionKind kind) const {
  return std::any_of(observers_.begin(), observers_.end(),
                     [&](const Observer& record) { return record.kind == kind; });
}

void Delivery::add_sink(std::shared_ptr<FrameSink> sink, double fps, Watch watch) {
  TW_REQUIRE(std::isfinite(fps) && fps > 0,
             "frames per second are " + show(fps) + "; expected a positive number");
  TW_REQUIRE(fps <= greatest_rate,
             "frames per second are " + show(fps) + "; expected at most " + show(greatest_rate));
  const double time = sim_.present.time;
  Sink record{std::move(sink), fps, watch, static_cast<long>(std::floor(time * fps))};
  while (record.next_time() < time) ++record.next_frame;
  sinks_.push_back(std::move(record));
}

bool Delivery::remove_sink(const FrameSink* sink) {
  return std::erase_if(sinks_, [&](const Sink& record) { return record.sink.get() == sink; }) > 0;
}

std::vector<double> Delivery::rates() const {
  std::vector<double> rates;
  for (const Sink& sink : sinks_) rates.push_back(sink.fps);
  return rates;
}

void Delivery::note(const std::shared_ptr<const Report>& report) {
  for (const Collision& told : *report)
    if (observed(told.kind)) undelivered_.emplace_back(report, &told);
}

// What one discontinuity tells has one key: in the order told.
void Delivery::sort_noted() {
  std::stable_sort(undelivered_.begin() + static_cast<std::ptrdiff_t>(sorted_), undelivered_.end(),
                   [](const auto& x, const auto& y) { return x->key < y->key; });
  sorted_ = undelivered_.size();
}

// Writing frames drives the stepping loop's data out of the processor's caches, so they go in
// batches: at the latest when the next slice begins or the run ends.
bool Delivery::is_worth_it() const {
  if (undelivered_.size() >= 8 * cost::frame_batch) return true;
  // states wait for their frames: memory
  if (sim_.graph.state_count() >= cost::most_waiting_states) return true;
  const double due = sim_.present.due.time;
  return std::any_of(sinks_.begin(), sinks_.end(), [&](const Sink& s) {
    return (due - s.next_time()) * s.fps >= cost::frame_batch;
  });
}

bool Delivery::deliver(double wall_end) {
  const double cpu = thread_cpu_seconds();
  struct AddTime {
    double& seconds;
    double start;
    ~AddTime() { seconds += thread_cpu_seconds() - start; }
  } add_time{sim_.present.counters.output_cpu_seconds, cpu};

  do {
    Sink* sink = nullptr;
    for (Sink& s : sinks_)
      if (!sink || s.next_time() < sink->next_time()) sink = &s;
    const bool frame_due = sink && sim_.present.due.reaches(sink->next_time());
    if (!undelivered_.empty() && (!frame_due || undelivered_.front()->time <= sink->next_time()))
      deliver_collision();
    else if (frame_due)
      deliver_frame(*sink);
    else
      return true;
  } while (wall_end == never || wall_seconds() < wall_end);
  return false;
}

void Delivery::deliver_collision() {
  const std::shared_ptr<const Collision> collision = undelivered_.front();
  while (next_observer_ < observers_.size()) {
    const Observer& record = observers_[next_observer_++];
    if (record.kind == collision->kind) (*record.observer)(*collision);
  }
  undelivered_.pop_front();
  --sorted_;
  next_observer_ = 0;
}

void Delivery::deliver_frame(Sink& record) {
  const double frame_time = record.next_time();
  const long index = record.next_frame++;
  std::vector<BodyPose> poses;
  for (const auto& body : sim_.scene.bodies) {
    if (body->fixed()) continue;
    const State* state = sim_.graph.last_at_or_before_time(body->process, frame_time);
    if (!state) continue;
    poses.push_back({body->id(), body_state(*body, state->trajectory().at(frame_time))});
  }
  double& deepest = sim_.present.counters.max_penetration;
  deepest = std::max(deepest, deepest_contact(sim_.scene, states_at(sim_, frame_time), frame_time));
  const std::shared_ptr<FrameSink> sink = record.sink;
  sink->frame(index, frame_time, poses);
}

double Delivery::first_needed(double otherwise) const {
  for (const Sink& sink : sinks_) otherwise = std::min(otherwise, sink.next_time());
  return otherwise;
}

Delivery::Kept Delivery::keep() const {
  Kept kept{observers_, sinks_};
  const auto is_outside = [](const auto& record) { return record.watch == Watch::outside; };
  std::erase_if(kept.observers, is_outside);
  std::erase_if(kept.sinks, is_outside);
  return kept;
}

void Delivery::restore(const Kept& kept) {
  const auto replace = [](auto& records, const auto& others) {
    std::erase_if(records, [](const auto& record) { return record.watch == Watch::of_scene; });
    records.insert(records.end(), others.begin(), others.end());
  };
  replace(observers_, kept.observers);
  replace(sinks_, kept.sinks);
}

void Delivery::restart() {
  undelivered_.clear();
  sorted_ = next_observer_ = 0;
  for (Sink& sink : sinks_) {
    sink.next_frame = 0;
    while (sim_.present.due.reaches(sink.next_time())) ++sink.next_frame;
  }
}

}  // namespace tw
