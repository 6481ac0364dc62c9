// Making groups: what a discontinuity leaves of links and contacts, and the groups that follow.
//
// A discontinuity that touches groups collects drafts of all their bodies, then the links and contacts
// that hold from there on (carried along, refreshed or new), and then cuts the drafts into connected
// components: each is a group, a body without links is isolated.  Kinematic and fixed bodies link
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
  GroupContact contact;          // a and b not yet set
  ContactTag tag;
  double gap = 0;                // m
  Vec3 normal = Vec3::UnitZ();   // from the reference body to the other
  Vec3 point = Vec3::Zero();
};

struct LooseLink {
  std::uint64_t pair = 0;
  std::uint32_t first = 0, count = 0;
  bool touched = false;
};

struct Regroup {
  Key key;
  std::vector<Draft>& drafts;
  std::vector<std::shared_ptr<Group>> old;  // whose members the drafts are, each once
  std::vector<LooseLink> links;
  std::vector<LooseContact> contacts;
  std::vector<std::pair<BodyId, std::size_t>> index;  // body, place in drafts; ascending
  double lightest = never, heaviest = 0;  // masses of the drafts, kg
  GroupTally tally;
  Told told;

  Regroup(const Key& k, std::vector<Draft>& d) : key(k), drafts(d) {}
  // The draft of a body; null if there is none.
  Draft* draft_of(BodyId id) const;
  void update_index();
};

}  // namespace tw
