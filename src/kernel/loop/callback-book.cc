// The book of callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/callback-book.h"

#include <algorithm>
#include <cmath>

#include "base/limits.h"
#include "kernel/loop/simulation.h"

namespace tw {

void CallbackBook::require_possible(const CallbackDef& def) const {
  const Present& present = sim_.present;
  TW_REQUIRE(!def.targets.empty(), "callback " + def.name + " has no targets; expected bodies");
  for (std::size_t i = 0; i < def.targets.size(); ++i)
    TW_REQUIRE(std::count(def.targets.begin(), def.targets.end(), def.targets[i]) == 1,
               "callback " + def.name + " names " + sim_.body(def.targets[i]).info.name +
                   " twice; expected each target once");
  TW_REQUIRE(std::isfinite(def.start), "start of callback " + def.name + " is " + show(def.start) +
                                           "; expected a finite number of seconds");
  TW_REQUIRE(std::abs(def.start) <= greatest_time, "start of callback " + def.name + " is " +
                                                       show(def.start) + " s; expected at most " +
                                                       show(greatest_time) + " s");
  TW_REQUIRE(!def.period || (std::isfinite(*def.period) && *def.period > 0),
             "period of callback " + def.name + " is " + show(def.period.value_or(0)) +
                 "; expected a positive number of seconds, or #f");
  TW_REQUIRE(!def.period || (*def.period >= least_period && *def.period <= greatest_time),
             "period of callback " + def.name + " is " + show(def.period.value_or(0)) +
                 " s; expected a time from " + show(least_period) + " to " + show(greatest_time) +
                 " s: more ticks could not be counted");
  TW_REQUIRE(
      def.period || def.start > present.time || (!present.begun && def.start == present.time),
      "start of callback " + def.name + " is " + show(def.start) +
          "; expected a time after the present (" + show(present.time) + " s)");
}

std::uint32_t CallbackBook::add(const CallbackDef& def) {
  const std::uint32_t number = static_cast<std::uint32_t>(records_.size());
  records_.push_back({});
  CallbackRecord& callback = records_.back();
  callback.def = def;
  callback.committed_next = def.start;
  callback.next = {def.start, 0, KeyKind::callback, number};
  // ticks before the present are not made up for
  const Key now = sim_.present.begun ? first_open() : Key{sim_.present.time, 0, KeyKind::birth, 0};
  if (def.period) callback.next = first_tick(callback, now);
  for (const BodyId id : def.targets) {
    Body& body = *sim_.scene.bodies[id];
    sim_.process(body).callbacks.push_back(number);
    body.callback_period = std::min(body.callback_period, def.period.value_or(never));
  }
  schedule(number);
  return number;
}

void CallbackBook::measure_periods() {
  for (const auto& body : sim_.scene.bodies) body->callback_period = never;
  for (const CallbackRecord& callback : records_)
    if (!callback.ended && callback.def.period)
      for (const BodyId id : callback.def.targets) {
        double& least = sim_.scene.bodies[id]->callback_period;
        least = std::min(least, *callback.def.period);
      }
}

bool CallbackBook::end(const Callback* which) {
  for (std::uint32_t number = 0; number < records_.size(); ++number) {
    CallbackRecord& callback = records_[number];
    if (callback.ended || callback.def.callback.get() != which) continue;
    callback.ended = true;
    schedule(number);
    measure_periods();
    return true;
  }
  return false;
}

bool CallbackBook::is_called(const Callback* which) const {
  return std::any_of(records_.begin(), records_.end(), [&](const CallbackRecord& callback) {
    return !callback.ended && callback.def.callback.get() == which;
  });
}

void CallbackBook::end_all_of(BodyId body) {
  for (std::uint32_t number = 0; number < records_.size(); ++number) {
    CallbackRecord& callback = records_[number];
    if (std::count(callback.def.targets.begin(), callback.def.targets.end(), body) == 0) continue;
    callback.ended = true;
    schedule(number);
  }
  measure_periods();
}

void CallbackBook::take_head_starts() {
  for (std::uint32_t number = 0; number < records_.size(); ++number) {
    CallbackRecord& callback = records_[number];
    for (const BodyId id : callback.def.targets)
      callback.head_start = std::max(callback.head_start, sim_.process(sim_.body(id)).head_start);
    schedule(number);
  }
}

Key CallbackBook::first_tick(const CallbackRecord& callback, const Key& key) const {
  const std::uint64_t number = static_cast<std::uint64_t>(&callback - records_.data());
  const auto tick = [&](double k) {
    return Key{callback.def.start + k * *callback.def.period, 0, KeyKind::callback, number};
  };
  double k = std::max(0.0, std::floor((key.time - callback.def.start) / *callback.def.period) - 1);
  while (tick(k) < key) ++k;
  return tick(k);
}

void CallbackBook::schedule(std::uint32_t number) {
  CallbackRecord& callback = records_[number];
  if (callback.next.time == never || callback.parked || callback.ended) {
    sim_.queue.withdraw(callback.event);
    return;
  }
  sim_.schedule(callback.event, callback.next, EventKind::callback, number, callback.head_start);
}

void CallbackBook::park(std::uint32_t number) {
  records_[number].parked = true;
  schedule(number);
}

void CallbackBook::move_on(std::uint32_t number, double next) {
  CallbackRecord& callback = records_[number];
  callback.next =
      callback.def.period
          ? first_tick(callback, {callback.next.time, 0, KeyKind::callback, number + 1ull})
          : Key{next, 0, KeyKind::callback, number};
  schedule(number);
}

void CallbackBook::rewind(std::uint32_t number, const Key& key) {
  CallbackRecord& callback = records_[number];
  const ProcessId target = sim_.process_of(callback.def.targets.front());
  callback.parked = false;
  if (!(callback.next < key)) {
    if (callback.def.period) {
      callback.next = first_tick(callback, key);
    } else {
      // the last record that is left says when
      double next = callback.committed_next;
      for (const State* s = sim_.graph.tail(target); s; s = s->prev)
        if (s->key.kind == KeyKind::callback && s->key.id == number) {
          next = s->next_callback;
          break;
        }
      callback.next = {next, 0, KeyKind::callback, number};
    }
  }
  // a call that stands is not made twice
  const State* tail = sim_.graph.last_at_or_before(target, callback.next);
  if (tail && tail->key == callback.next && callback.def.period)
    callback.next = first_tick(callback, {callback.next.time, 0, KeyKind::callback, number + 1ull});
  schedule(number);
}

void CallbackBook::note_committed(const State& state) {
  CallbackRecord& callback = records_[state.key.id];
  if (state.process == sim_.process_of(callback.def.targets.front()))
    callback.committed_next = state.next_callback;
}

Key CallbackBook::first_open() const {
  const Present& present = sim_.present;
  if (!present.begun) return Key{};
  return present.due.inclusive ? Key{present.time, 0, KeyKind::group_check, 0} : present.key();
}

std::vector<CallbackRecord> CallbackBook::keep() const {
  std::vector<CallbackRecord> kept = records_;
  for (std::size_t number = 0; number < kept.size(); ++number) {
    CallbackRecord& callback = kept[number];
    callback.next = callback.def.period
                        ? first_tick(records_[number], first_open())
                        : Key{callback.committed_next, 0, KeyKind::callback, number};
    callback.parked = false;
    callback.event = EventQueue::none;
  }
  return kept;
}

void CallbackBook::restore(const std::vector<CallbackRecord>& kept) {
  for (CallbackRecord& callback : records_) sim_.queue.withdraw(callback.event);
  for (Process& process : sim_.processes) process.callbacks.clear();
  records_ = kept;
  for (std::uint32_t number = 0; number < records_.size(); ++number) {
    for (const BodyId id : records_[number].def.targets)
      sim_.process(sim_.body(id)).callbacks.push_back(number);
    schedule(number);
  }
  measure_periods();
}

}  // namespace tw
