// Impacts that a helper decides before their events, beside what the loop does meanwhile: claims
// above all, which take longer.
//
// The loop goes on: states enter, claims grow.  So a helper looks at the graph as it was when it
// began, and at those alone whose arcs are known beyond the impact: these stay as they are until
// something enters before it.  The event uses the decision if all states that it was made of are
// still the last ones before its key, else it decides anew; the bits are the same.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "groups/before.h"
#include "kernel/loop/decided-ahead.h"
#include "kernel/report/counters.h"
#include "timeline/event-queue.h"

namespace tw {

class ActivePairs;
class Horizon;
class PairChecks;
struct Pair;
struct Simulation;

class ImpactsAhead {
 public:
  // Decides what an impact of two bodies comes to, by one who may be at it while others are at
  // others.  What it reads may throw ReadLog::Unreadable.
  using Decide = std::function<void(BodyId a, BodyId b, const Before&, Decision&)>;

  ImpactsAhead(Simulation& simulation, const Horizon& horizon, const ActivePairs& pairs,
               const PairChecks& checks, Decide decide);
  ~ImpactsAhead();

  // Has the next impacts decided after the advance event of a body, if anything is new since the
  // last look.
  void look(const Event& event);
  // What was decided for the key; null: nothing, or it holds no more.
  std::unique_ptr<Decision> take(const Key& key);
  // Waits for those that are being decided; others are not begun.
  void rest();
  void forget();

 private:
  struct Ahead;
  bool is_worth_it(const Event& event) const;
  void begin(const Pair& pair);
  void decide(Ahead& ahead) const;
  bool is_past(const Ahead& ahead, double now);

  Simulation& sim_;
  Counters& counters_;
  const Horizon& horizon_;
  const ActivePairs& pairs_;
  const PairChecks& checks_;
  const Decide decide_;
  std::vector<std::unique_ptr<Ahead>> all_;
  std::uint64_t seen_ = 0;  // impacts found and states entered at the last look
};

}  // namespace tw
