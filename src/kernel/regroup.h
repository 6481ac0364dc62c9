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

#include "kernel/draft.h"
#include "kernel/group.h"

namespace tw {

// A contact on its way into a group, with what it looks like now (world frame).
struct LooseContact {
  GroupContact contact;  // a and b not yet set
  ContactTag tag;
  double gap = 0;               // m
  Vec3 normal = Vec3::UnitZ();  // from the reference body to the other
  Vec3 point = Vec3::Zero();
};

struct LooseLink {
  std::uint64_t pair = 0;
  std::uint32_t first = 0, count = 0;
  bool touched = false;
};

// A link before the discontinuity, in the group that has the say in it.
struct OldLink {
  std::uint64_t pair = 0;
  std::shared_ptr<Group> group;
  const GroupLink* link = nullptr;
};

// What a discontinuity does to the contacts of the bodies it concerns.
struct Occasion {
  bool whole = false;   // their fellows all get new arcs too
  bool fusion = false;  // the first two come to touch
  bool look = false;    // their contacts are found anew: a group check
  bool early = false;   // before that of their groups
  bool blow = false;    // impulses are passed on
};

struct Regroup {
  Key key;
  std::vector<Draft>& drafts;   // with new arcs: the bodies concerned; else those at the border
  Groups old;                   // whose members get new arcs, each once
  std::vector<OldLink> before;  // of bodies with new arcs, ascending pairs
  bool has_border = false;
  bool may_sleep = false;            // the check of whole groups
  bool rests_provisionally = false;  // whatever comes to rest does so for the time being
  std::vector<Calm> calm;            // of the drafts
  std::vector<bool> asleep;          // of the drafts: laid to rest provisionally
  std::vector<LooseLink> links;
  std::vector<LooseContact> contacts;
  Groups made;
  std::vector<std::pair<BodyId, std::size_t>> index;  // body, place in drafts; ascending
  double lightest = never, heaviest = 0;  // kg, of the drafts and, at a border, of their groups
  Tally tally;
  Told told;

  Regroup(const Key& k, std::vector<Draft>& d) : key(k), drafts(d) {}
  // The draft of a body; null if there is none.
  Draft* draft_of(BodyId id) const;
  void update_index();
  // Whether the discontinuity gives it a new arc.
  bool changes(const Draft* draft) const {
    return draft && draft->body->dynamic() && draft->data.arc_key == key;
  }
  // Null if the pair was not linked.
  const OldLink* link_before(std::uint64_t pair) const;
};

}  // namespace tw
