// Contact groups: a set of bodies in persistent contact, from one discontinuity to the next.
//
// A Group is made by the discontinuity that gives its members new arcs (fusion, group check, impact on a
// member, a callback that changed one) and never changes; its members' states share it.  Its arc is
// integrated when it is first looked at, which is a function of the group alone.
//
// Group checks lie at birth + k 2^j / rate.  A group at rest has no next check: its members' arcs are
// constant until something touches one of them.
//
// Source: the paper, section 4.4; doc/architecture.md, "Contact groups".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "integrate/group-arc.h"
#include "kernel/key.h"

namespace tw {

// A pair of bodies in contact, one of them a member: it has no collision checks.  Its contacts stand in
// a row; it may have none (a ghost at a seam).
struct GroupLink {
  std::uint64_t pair = 0;          // pair_id of the bodies
  std::uint32_t first = 0, count = 0;
  bool touched = false;            // has carried a load since it was linked
};

// Which features of which bodies meet at a contact: how it is found again after a refresh.
struct ContactTag {
  std::uint32_t reference = 0, other = 0;  // bodies: a and b of the contact
  int parts = 0;                   // pair of parts
  std::uint64_t feature = 0;
};

struct Group {
  Key key;                         // of the discontinuity that made it
  double birth = 0;                // when this set of members came together, s
  double next_check = never;
  bool end_tested = false;         // next_check takes what end-test.cc found into account
  bool at_rest = false;
  double quiet_since = never;      // s: slow, and nothing slips; `never`: not so
  double quiet_speed = 0;          // m/s, at that time
  double first_step = 0;           // of the arc, s; 0: chosen
  std::vector<std::uint32_t> members;   // body ids, ascending
  std::vector<std::uint32_t> outside;   // body ids of arc->start().outside
  std::vector<GroupLink> links;         // ascending pairs
  std::vector<ContactTag> tags;         // of arc->start().contacts
  std::vector<double> gaps;             // m, of arc->start().contacts, at the start
  std::unique_ptr<GroupArc> arc;

  std::uint32_t leader() const { return members.front(); }
  const GroupLink* link(std::uint64_t pair) const {
    const auto at = std::lower_bound(links.begin(), links.end(), pair,
                                     [](const GroupLink& l, std::uint64_t p) { return l.pair < p; });
    return at != links.end() && at->pair == pair ? &*at : nullptr;
  }
  // Where the arcs of its members end by themselves, s.
  double end() const { return next_check; }
};

// What a discontinuity did to groups: statistics.
struct GroupTally {
  std::uint16_t fusions = 0, fissions = 0, contact_changes = 0;
};

}  // namespace tw
