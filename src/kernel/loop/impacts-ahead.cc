// Impacts that are decided before their events.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/loop/impacts-ahead.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "base/parallel.h"
#include "kernel/loop/active-pairs.h"
#include "kernel/loop/horizon.h"
#include "kernel/loop/pair-checks.h"
#include "kernel/loop/simulation.h"

namespace tw {

struct ImpactsAhead::Ahead {
  BodyId a = 0, b = 0;
  std::uint64_t entered = 0;  // how many states there were when it was begun
  std::unique_ptr<Decision> decision = std::make_unique<Decision>();
  bool is_decided = false;
  std::optional<Beside> work;  // last: it ends before the rest goes
};

ImpactsAhead::ImpactsAhead(Simulation& simulation, const Horizon& horizon, const ActivePairs& pairs,
                           const PairChecks& checks, Decide decide)
    : sim_(simulation),
      counters_(simulation.present.counters),
      horizon_(horizon),
      pairs_(pairs),
      checks_(checks),
      decide_(std::move(decide)) {
  sim_.graph.before_removal([this] { rest(); });
}

ImpactsAhead::~ImpactsAhead() = default;

void ImpactsAhead::rest() {
  for (const std::unique_ptr<Ahead>& ahead : all_) ahead->work->finish();
}

void ImpactsAhead::forget() {
  all_.clear();
  seen_ = 0;
}

// Of two that fly all is done at once, and a large group is decided best by all threads together.
bool ImpactsAhead::is_worth_it(const Event& event) const {
  if (event.kind != EventKind::pair) return false;
  const Pair& pair = pairs_[event.subject];
  if (!pair.pending) return false;
  bool is_in_group = false;
  for (const BodyId body : {pair.a, pair.b}) {
    const State& tail = *sim_.graph.tail(sim_.process_of(body));
    if (!horizon_.may_be_read_beside(tail, pair.impact)) return false;
    if (tail.group && tail.group->members.size() > cost::largest_ahead) return false;
    is_in_group = is_in_group || tail.group;
  }
  return is_in_group && std::none_of(all_.begin(), all_.end(), [&](const auto& ahead) {
           return ahead->decision->key == pair.impact;
         });
}

void ImpactsAhead::begin(const Pair& pair) {
  const auto& ahead = all_.emplace_back(std::make_unique<Ahead>());
  ahead->a = pair.a;
  ahead->b = pair.b;
  ahead->entered = sim_.graph.entered();
  ahead->decision->key = pair.impact;
  ahead->work.emplace(*Team::current(), [this, of = ahead.get()] { decide(*of); });
}

void ImpactsAhead::decide(Ahead& ahead) const {
  Decision& decision = *ahead.decision;
  const Key& key = decision.key;
  decision.log.restrict_to(
      [&](const State& state) { return horizon_.may_be_read_beside(state, key); });
  try {
    decide_(ahead.a, ahead.b, sim_.before(key, &decision.log, ahead.entered), decision);
    decision.log.close();
    ahead.is_decided = true;
  } catch (const ReadLog::Unreadable&) {
  }
}

// Whether nobody will ask for it, as it holds no more or came to nothing.
bool ImpactsAhead::is_past(const Ahead& ahead, double now) {
  if (!ahead.work->is_over()) return false;
  if (!ahead.is_decided) return true;
  const Key& key = ahead.decision->key;
  if (key.time >= now && ahead.decision->log.holds(sim_.graph, key)) return false;
  ++counters_.impacts_decided_ahead;
  return true;
}

void ImpactsAhead::look(const Event& event) {
  // a gas has no groups, and no time to look
  if (!Team::current() || !sim_.graph.tail(sim_.process_of(event.subject))->group) return;
  const std::uint64_t seen = checks_.impacts_found() + sim_.graph.entered();
  if (seen == seen_) return;
  seen_ = seen;
  std::erase_if(all_, [&](const auto& ahead) { return is_past(*ahead, event.key.time); });
  const auto undecided = std::count_if(all_.begin(), all_.end(),
                                       [](const auto& ahead) { return !ahead->work->is_over(); });
  if (all_.size() >= cost::most_ahead || undecided >= cost::most_undecided) return;
  // what comes at once is the loop's own
  const Event& top = sim_.queue.top();
  const Event* next = sim_.queue.first_of(
      event.key.time + cost::look_ahead,
      [&](const Event& other) { return other.key != top.key && is_worth_it(other); });
  if (next) begin(pairs_[next->subject]);
}

std::unique_ptr<Decision> ImpactsAhead::take(const Key& key) {
  const auto at = std::find_if(all_.begin(), all_.end(),
                               [&](const auto& ahead) { return ahead->decision->key == key; });
  if (at == all_.end()) return nullptr;
  const std::unique_ptr<Ahead> ahead = std::move(*at);
  all_.erase(at);
  ahead->work->finish();
  if (!ahead->is_decided) return nullptr;
  ++counters_.impacts_decided_ahead;
  if (!ahead->decision->log.holds(sim_.graph, key)) return nullptr;
  ++counters_.impact_decisions_used;
  return std::move(ahead->decision);
}

}  // namespace tw
