// What group checks come to, decided ahead of their events: each is used if what it was made of
// still stands before its key by then.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "groups/read-log.h"
#include "groups/told/group-counters.h"
#include "timeline/successor.h"

namespace tw {

// A function of what stands before the key.
struct Decision {
  Key key;
  std::vector<ProcessId> concerned;  // of a check: whose it is; ascending
  std::vector<Successor> successors;
  GroupCounters counters;
  ReadLog log;
};

class DecidedAhead {
 public:
  // Adds those that are not null, and says how many these are; one of the same key goes.
  std::size_t add(std::vector<std::unique_ptr<Decision>> decisions);
  // Whether anything was decided for that instant.
  bool has_at(double time) const;
  // What was decided for the key; null: nothing, or it holds no more.
  std::unique_ptr<Decision> take(const Key& key, const StateGraph& graph);
  // Those before the time, s, are past.
  void forget_before(double time);
  void forget() { decisions_.clear(); }

 private:
  std::vector<std::unique_ptr<Decision>> decisions_;  // by key
};

}  // namespace tw
