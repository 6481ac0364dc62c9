// Random state graphs, and a brute-force search for what a rollback must remove.
//
// The oracle: states are nodes; from each an edge leads to the next one of its queue and to the
// others of its ring.  Rolling process p back to key K removes what is reachable from p's first
// state with key >= K, and nothing else.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "timeline/state-graph.h"

namespace tw::test {

// A state by name, so that it can be spoken of after it is gone.
using StateName = std::pair<std::uint32_t, double>;  // process, time

inline std::set<StateName> names_in(const StateGraph& graph) {
  std::set<StateName> names;
  for (std::uint32_t p = 0; p < graph.process_count(); ++p)
    for (const State* s = graph.head(ProcessId{p}); s; s = s->next) names.insert({p, s->key.time});
  return names;
}

inline Key impact_at(double time) { return {time, 1, KeyKind::impact, 0}; }

// Appends the states of one discontinuity to the queues of `processes`, and closes the ring.
inline std::vector<State*> append_ring(StateGraph& graph,
                                       const std::vector<std::uint32_t>& processes,
                                       const Key& key) {
  std::vector<State*> ring;
  for (const std::uint32_t p : processes) ring.push_back(graph.append(ProcessId{p}, key));
  graph.close_ring(ring);
  return ring;
}

// Births at time 0, then discontinuities at 1, 2, ... of 1 to `widest` processes each.
inline void fill_randomly(StateGraph& graph, std::uint32_t processes, int discontinuities,
                          std::uint32_t widest, Random& random) {
  for (std::uint32_t p = 0; p < processes; ++p) {
    graph.add_process();
    graph.append(ProcessId{p}, {0, 0, KeyKind::birth, p});
  }
  for (int i = 1; i <= discontinuities; ++i) {
    std::set<std::uint32_t> members;
    const std::uint64_t width = 1 + random.below(std::min(widest, processes));
    while (members.size() < width)
      members.insert(static_cast<std::uint32_t>(random.below(processes)));
    append_ring(graph, {members.begin(), members.end()}, impact_at(i));
  }
}

// Everything reachable, by a search that knows nothing of work lists.
inline std::set<StateName> reachable(const StateGraph& graph, std::uint32_t process,
                                     const Key& key) {
  std::set<StateName> found;
  std::vector<const State*> open;
  for (const State* s = graph.head(ProcessId{process}); s; s = s->next)
    if (s->key >= key) {
      open.push_back(s);
      break;
    }
  while (!open.empty()) {
    const State* s = open.back();
    open.pop_back();
    if (!s || !found.insert({number(s->process), s->key.time}).second) continue;
    open.push_back(s->next);
    for (const State* r = s->ring; r != s; r = r->ring) open.push_back(r);
  }
  return found;
}

// Rolls back and returns the names of the states that went.
inline std::set<StateName> removed_by_rollback(StateGraph& graph, std::uint32_t process,
                                               const Key& key, std::vector<Affected>& affected) {
  std::set<StateName> removed;
  graph.rollback(ProcessId{process}, key, affected, [&](State& s) {
    removed.insert({number(s.process), s.key.time});
  });
  return removed;
}

}  // namespace tw::test
