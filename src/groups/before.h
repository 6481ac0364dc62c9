// What stands before a key: the one reader of states and of who is in contact with whom.
//
// A contact pair may stand in two groups: in that of a region that a blow gave new arcs, and in
// that of those who keep theirs.  One of them *owns* it: the one that was made last, and of two
// made at once the one that moves.  Only its contacts count.  Whoever walks along contacts does so
// here.
//
// A look at a graph that stays as it is: nothing is kept, nothing changes.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "dynamics/placed-body.h"
#include "dynamics/scene.h"
#include "groups/group.h"
#include "groups/read-log.h"
#include "timeline/state-graph.h"
#include "timeline/swept-bounds.h"

namespace tw {

// The group that owns what contact two dynamic bodies in these states have; null: they have none.
const std::shared_ptr<Group>& owner_of(const State& a, const State& b);
// The same of any two bodies: what fixed and kinematic ones touch is owned by the other's group.
const std::shared_ptr<Group>& owner_of(const Body& body_a, const State& a, const Body& body_b,
                                       const State& b);

class Before {
 public:
  // `log`: notes what states are read; may be null.  Of all states that have entered, or of the
  // first `entered` ones.
  Before(const Scene& scene, const StateGraph& graph, const Key& key, ReadLog* log = nullptr,
         std::uint64_t entered = StateGraph::all_states)
      : scene_(scene), graph_(graph), key_(key), log_(log), entered_(entered) {}

  const Scene& scene() const { return scene_; }
  const Key& key() const { return key_; }
  // The last state below the key; one there must be.
  const State& state(ProcessId process) const {
    const State& state = *graph_.last_before(process, key_, entered_);
    if (log_) log_->note(state);
    return state;
  }
  const State& state_of(BodyId body) const { return state(scene_.process_of(body)); }
  // Where the body is, on the arc before the key, at its time.
  PlacedBody placed(BodyId id) const;

  // The pair as its owner has it; null where the two are not in contact.
  struct Owned {
    std::shared_ptr<Group> owner;
    const ContactPair* pair = nullptr;
  };
  Owned owned(std::uint64_t pair) const;

  // Calls visit(owner, pair, other body) for each dynamic body in contact with one of the
  // process's.
  template <class Visit>
  void visit_contacts(ProcessId process, Visit&& visit) const;
  template <class Visit>
  void visit_contacts(const std::vector<ProcessId>& processes, Visit&& visit) const {
    for (const ProcessId process : processes) visit_contacts(process, visit);
  }

  // Those of its members that have not left it; ascending.
  std::vector<ProcessId> remaining(const Group& group) const;
  // The process, and all that hangs together with it; ascending.
  std::vector<ProcessId> hanging_together(ProcessId process) const;

 private:
  const Scene& scene_;
  const StateGraph& graph_;
  Key key_;
  ReadLog* log_;
  std::uint64_t entered_;
};

// Sets of processes are rows, ascending.
void insert(std::vector<ProcessId>& processes, ProcessId process);
bool holds(const std::vector<ProcessId>& processes, ProcessId process);

// ---- templates ----

template <class Visit>
void Before::visit_contacts(ProcessId process, Visit&& visit) const {
  const State& state = this->state(process);
  const Group* group = state.group.get();
  if (!group || state.error) return;
  for (const std::uint32_t number : group->pairs_of(state.member)) {
    const ContactPair& pair = group->pairs[number];
    const BodyId other = scene_.process_of(pair.a()) == process ? pair.b() : pair.a();
    if (!scene_.body(other).dynamic()) continue;
    const State& theirs = state_of(other);
    const Group* owner = owner_of(state, theirs).get();
    const ContactPair* owned = owner == group ? &pair : owner ? owner->find(pair.id) : nullptr;
    if (owned && !theirs.error) visit(*owner, *owned, other);
  }
}

}  // namespace tw
