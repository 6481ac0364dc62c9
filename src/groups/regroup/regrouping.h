// A regrouping: what a discontinuity concerns, and what stood there before it.
//
// The question that all phases of regroup.h are asked.  It stays as it is; of the successors of all
// that take part, which it refers to, phases change how they move on.  What follows is in values
// that phases make from it and pass on: Contacts, Parts, MadeGroups, and what is told.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "groups/before.h"
#include "groups/contacts/surroundings.h"
#include "groups/group.h"
#include "groups/placed/placed-together.h"
#include "groups/told/group-counters.h"
#include "timeline/successor.h"

namespace tw {

// What sets a regrouping off.
enum class Cause : std::uint8_t {
  fusion,       // a soft impact: the first two come to touch
  impact,       // a hard one on a member: impulses are passed on
  callback,     // a callback changed members
  check,        // a group check: contacts are found anew, what hangs together joins again
  early_check,  // the same of members whose arcs end before the check of their group
  edit          // between runs: whole groups get new arcs
};

inline bool finds_contacts(Cause cause) {
  return cause == Cause::check || cause == Cause::early_check;
}
inline bool passes_impulses(Cause cause) { return cause == Cause::impact || finds_contacts(cause); }

struct RegroupRequest {
  Cause cause;
  bool reports_fissions = false;             // somebody wants to hear of them
  bool reports_fusions = false;              // of others than the first two
  const PlacedTogether* together = nullptr;  // null: nobody was
};

// Of a fusion of what was placed touching: what was placed together with it, and is to begin with
// loads (placed-loads.h).
struct PlacedNow {
  std::vector<BodyId> bodies;           // ascending; empty: nothing
  std::vector<std::uint64_t> left_out;  // pairs that carry nothing in that balance, ascending
  bool starts_loaded = false;
};

// A contact pair before the discontinuity, in the group that owns it.
struct PairBefore {
  std::uint64_t id = 0;
  std::shared_ptr<Group> owner;
  const ContactPair* pair = nullptr;
};

// What one phase adds to what the discontinuity tells.
struct Told {
  Tally tally;
  Report report;

  void add(const Told& more) {
    tally.add(more.tally);
    report.insert(report.end(), more.report.begin(), more.report.end());
  }
};

struct Regrouping {
  const Before& before;
  const Surroundings& surroundings;
  const RegroupRequest& request;
  const PlacedNow& placed_now;
  std::vector<Successor>& successors;  // of all that take part

  Groups old;                            // whose members get new arcs, each once
  std::vector<PairBefore> pairs_before;  // of processes with new arcs, ascending
  bool has_border = false;
  MassRange masses;  // of the successors with new arcs and, at a border, of all groups there

  Regrouping(const Before& standing, const Surroundings& near, const RegroupRequest& asked,
             const PlacedNow& now, std::vector<Successor>& all);

  const Scene& scene() const { return before.scene(); }
  const Key& key() const { return before.key(); }
  double now() const { return before.key().time; }
  Cause cause() const { return request.cause; }

  // Null if it takes no part.
  Successor* successor_of(ProcessId process) const;
  Successor* successor_of(BodyId body) const { return successor_of(scene().process_of(body)); }
  std::size_t place_of(const Successor* successor) const {
    return static_cast<std::size_t>(successor - successors.data());
  }
  // Places among the successors, by ascending process.
  const std::vector<std::pair<ProcessId, std::size_t>>& index() const { return index_; }

  // Whether the discontinuity gives it a new arc.
  static bool changes(const Successor* successor) { return successor && successor->starts_arc(); }
  bool changes(BodyId body) const { return changes(successor_of(body)); }
  // A dynamic body that keeps its arc: it stands at the border, or farther off.
  bool lies_beyond(BodyId body) const { return scene().body(body).dynamic() && !changes(body); }
  // Null if the two were not in contact.
  const PairBefore* pair_before(std::uint64_t pair) const;
  // Where a body is now: by its successor, or, of one without, on its motion.
  PlacedBody placed(BodyId body) const;
  Quat attitude(BodyId body) const;
  // What observers hear of a pair, but for where and how fast.
  Collision told_of(CollisionKind kind, const ContactPair& pair) const;

 private:
  // By process, with linear probing: they are looked up some hundred times for each of them.
  struct Slot {
    ProcessId process{};
    std::uint32_t place = none;
  };
  static constexpr std::uint32_t none = 0xffffffffu;
  std::size_t slot_of(ProcessId process) const;
  void index_successors();
  void collect_groups();
  void collect_pairs();

  std::vector<std::pair<ProcessId, std::size_t>> index_;
  std::vector<Slot> slots_;  // a power of two
};

inline PlacedBody placed(const Successor& successor) {
  return PlacedBody(*successor.body, successor.point);
}

}  // namespace tw
