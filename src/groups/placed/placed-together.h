// Who was placed touching whom: all that hang together so come together at their first touch.
//
// Loads (placed-loads.h) are right for the whole alone: what joins a heap one by one finds the
// loads of those before it, that are too small, and has all of them found anew.  So the pairs that
// touch where they were put are noted, and the first fusion of one body takes all with it.  Those
// that overlap there by more than touch come into contact when the next run begins.
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
  void note(BodyId a, BodyId b, double when, bool overlap) {
    if (when != when_) pairs_.clear();
    when_ = when;
    pairs_.emplace_back(a, b);
    pairs_.emplace_back(b, a);
    if (overlap) overlapping_.emplace_back(std::min(a, b), std::max(a, b));
    sorted_ = false;
  }
  // It is put elsewhere, or taken out.
  void forget(BodyId id) {
    const auto has_it = [&](const Pair& p) { return p.first == id || p.second == id; };
    std::erase_if(pairs_, has_it);
    std::erase_if(overlapping_, has_it);
  }
  // The pairs that overlap and were not asked for yet, each once; ascending.
  std::vector<Pair> take_overlapping() {
    std::sort(overlapping_.begin(), overlapping_.end());
    overlapping_.erase(std::unique(overlapping_.begin(), overlapping_.end()), overlapping_.end());
    return std::exchange(overlapping_, {});
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
  std::vector<Pair> overlapping_;
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
