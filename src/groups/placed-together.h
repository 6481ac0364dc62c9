// Who was placed touching whom: all that hang together so come together at their first touch.
//
// Loads (placed-loads.h) are right for the whole alone: what joins a heap one by one finds the
// loads of those before it, that are too small, and has all of them found anew.  So the pairs that
// touch where they were put are noted, and the first fusion of one body takes all with it.
//
// A value, known before anything moves: the same for all schedules.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "dynamics/scene.h"

namespace tw {

class PlacedTogether {
 public:
  using Pair = std::pair<BodyId, BodyId>;

  // These touch where they were put, one of them at `when`, s: those of other times are past.
  void note(BodyId a, BodyId b, double when) {
    if (when != when_) pairs_.clear();
    when_ = when;
    pairs_.emplace_back(a, b);
    pairs_.emplace_back(b, a);
    sorted_ = false;
  }
  // It is put elsewhere, or taken out.
  void forget(BodyId id) {
    std::erase_if(pairs_, [&](const Pair& p) { return p.first == id || p.second == id; });
  }
  // After the last was noted, before the first question.
  void settle() {
    if (sorted_) return;
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    sorted_ = true;
  }

  // The dynamic bodies that hang together with some of these, and these; ascending.
  std::vector<BodyId> hanging_together(const Scene& scene, std::vector<BodyId> bodies) const;
  // Those that touch one of them.
  template <class Visit>
  void visit_touching(BodyId body, Visit&& visit) const {
    for (auto at = std::lower_bound(pairs_.begin(), pairs_.end(), Pair{body, BodyId{0}});
         at != pairs_.end() && at->first == body; ++at)
      visit(at->second);
  }

 private:
  std::vector<Pair> pairs_;  // from either side
  double when_ = 0;
  bool sorted_ = true;
};

inline std::vector<BodyId> PlacedTogether::hanging_together(const Scene& scene,
                                                            std::vector<BodyId> bodies) const {
  std::vector<BodyId> open = bodies;
  std::sort(bodies.begin(), bodies.end());
  while (!open.empty()) {
    const BodyId body = open.back();
    open.pop_back();
    visit_touching(body, [&](BodyId other) {
      if (!scene.body(other).dynamic()) return;
      const auto at = std::lower_bound(bodies.begin(), bodies.end(), other);
      if (at != bodies.end() && *at == other) return;
      bodies.insert(at, other);
      open.push_back(other);
    });
  }
  return bodies;
}

}  // namespace tw
