// Making groups: what a discontinuity leaves of links and contacts, and the groups that follow.
//
// A discontinuity that touches groups chooses the bodies that get new arcs (region.cc), collects
// drafts of them and of those at their border, then the links and contacts that hold from there on
// (carried along, refreshed or new), and then cuts the drafts into connected components: each is a
// group, a body without links is isolated.  Kinematic and fixed bodies and those at the border link
// nothing together.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "groups/group.h"
#include "timeline/successor.h"

namespace tw {

// A contact on its way into a group, with what it looks like now (world frame).
struct NewContact {
  GroupContact contact;  // a and b not yet set
  ContactTag tag;
  double gap = 0;               // m
  Vec3 normal = Vec3::UnitZ();  // from the reference body to the other
  Vec3 point = Vec3::Zero();
};

struct NewContactPair {
  std::uint64_t id = 0;
  std::uint32_t first = 0, count = 0;
  bool has_borne_load = false;
};

// A contact pair before the discontinuity, in the group that owns it.
struct PairBefore {
  std::uint64_t id = 0;
  std::shared_ptr<Group> group;
  const ContactPair* pair = nullptr;
};

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

struct Regrouping {
  Key key;
  std::vector<Successor>&
      successors;                  // with new arcs: the bodies concerned; else those at the border
  Groups old;                      // whose members get new arcs, each once
  std::vector<PairBefore> before;  // of bodies with new arcs, ascending pairs
  bool has_border = false;
  bool may_sleep = false;            // the check of whole groups
  bool falls_asleep = false;         // whatever comes to rest does so for the time being
  std::vector<Stillness> stillness;  // of the drafts
  std::vector<bool> asleep;          // of the drafts: laid to rest provisionally
  std::vector<NewContactPair> pairs;
  std::vector<NewContact> contacts;
  Groups made;
  std::vector<std::pair<BodyId, std::size_t>> index;  // body, place in drafts; ascending
  double lightest = never, heaviest = 0;  // kg, of the drafts and, at a border, of their groups
  Tally tally;
  Report report;

  Regrouping(const Key& k, std::vector<Successor>& d) : key(k), successors(d) {}
  // The draft of a body; null if there is none.
  Successor* successor_of(BodyId id) const;
  void update_index();
  // Whether the discontinuity gives it a new arc.
  bool changes(const Successor* successor) const { return successor && successor->starts_arc(); }
  // Null if the pair was not linked.
  const PairBefore* pair_before(std::uint64_t pair) const;
};

}  // namespace tw
