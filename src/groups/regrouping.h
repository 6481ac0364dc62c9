// A regrouping: what a discontinuity leaves of contacts, and the groups that follow.
//
// It has the successors of all that take part, then the contact pairs that hold from there on
// (carried along, refreshed or new), and in the end the groups.  A value that the functions of this
// folder pass on: nothing in it outlives the discontinuity but the successors and the groups.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision/separation.h"
#include "groups/before.h"
#include "groups/group-counters.h"
#include "groups/group.h"
#include "groups/placed-together.h"
#include "groups/surroundings.h"
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

// A contact on its way into a group, with what it looks like now (world frame).
struct NewContact {
  GroupContact contact;  // a and b not yet set
  ContactTag tag;
  double gap = 0;               // m
  Vec3 normal = Vec3::UnitZ();  // from the reference body to the other
  Vec3 point = Vec3::Zero();
  std::optional<ContactConstants> law_before;  // none: nothing of it was there
  double share_before = 1;
  bool foreseen = false;  // it is where the one before was followed to (foreseen.h)

  // The gap up to which it presses, but for the law's own depth, m.
  double reach() const { return std::max(contact.offset, 0.0); }
};

// How fast overlaps are pushed apart, m/s.
inline double push_speed(const Scene& scene, double size) {
  return answer::push_share * std::sqrt(scene.gravity_scale() * size);
}
// Whether a contact with that offset holds an overlap that is to be pushed apart.
inline bool pushes(const Scene& scene, double offset) {
  return scene.options.push_overlaps && offset < 0;
}

// A contact pair before the discontinuity, in the group that owns it.
struct PairBefore {
  std::uint64_t id = 0;
  std::shared_ptr<Group> owner;
  const ContactPair* pair = nullptr;
};

struct Regrouping {
  const Before& before;
  const Surroundings& surroundings;
  Cause cause;
  bool reports_fissions = false;  // somebody wants to hear of them
  bool reports_fusions = false;
  // Of a fusion of what was placed touching: all that were placed together with it, ascending.
  std::vector<BodyId> placed_bodies;
  const PlacedTogether* together = nullptr;
  // Pairs that carry nothing in the balance of what was placed: found with the loads, and those
  // that were found before and are left to themselves.  Ascending.
  std::vector<std::uint64_t> unloaded, left_out;
  bool starts_loaded = false;          // its groups do
  std::vector<Successor>& successors;  // of all that take part

  Groups old;                            // whose members get new arcs, each once
  std::vector<PairBefore> pairs_before;  // of processes with new arcs, ascending
  bool has_border = false;
  std::vector<bool> touching;        // of the successors: who is in contact with anything
  std::vector<Stillness> stillness;  // of the successors
  std::vector<bool> rests;           // of the successors: who comes to rest
  std::vector<ContactPair> pairs;    // from here on; their contacts in a row of `contacts`
  std::vector<NewContact> contacts;
  Groups made;
  MassRange masses;  // of the successors and, at a border, of their groups
  Tally tally;
  Report report;
  GroupCounters counters;

  Regrouping(const Before& standing, const Surroundings& near, Cause why,
             std::vector<Successor>& all)
      : before(standing), surroundings(near), cause(why), successors(all) {
    update_index();
  }

  const Scene& scene() const { return before.scene(); }
  const Key& key() const { return before.key(); }
  double now() const { return before.key().time; }

  // Null if it takes no part.
  Successor* successor_of(ProcessId process) const;
  Successor* successor_of(BodyId body) const { return successor_of(scene().process_of(body)); }
  std::size_t place_of(const Successor* successor) const {
    return static_cast<std::size_t>(successor - successors.data());
  }
  // Places among the successors, by ascending process.
  const std::vector<std::pair<ProcessId, std::size_t>>& index() const { return index_; }
  void update_index();

  // Whether the discontinuity gives it a new arc.
  static bool changes(const Successor* successor) { return successor && successor->starts_arc(); }
  bool changes(BodyId body) const { return changes(successor_of(body)); }
  // A dynamic body that keeps its arc: it stands at the border, or farther off.
  bool lies_beyond(BodyId body) const { return scene().body(body).dynamic() && !changes(body); }
  // Whether one of the pair's contacts holds an overlap that is to be pushed apart.
  bool pushes_apart(const ContactPair& pair) const;
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

  std::vector<std::pair<ProcessId, std::size_t>> index_;
  std::vector<Slot> slots_;  // a power of two
};

inline PlacedBody placed(const Successor& successor) {
  return PlacedBody(*successor.body, successor.point);
}

}  // namespace tw
