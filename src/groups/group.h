// Contact groups: a set of processes in persistent contact, from one discontinuity to the next.
//
// A Group is made by the discontinuity that gives its members new arcs; their states share it.  Its
// arc is integrated when it is first needed, which is a function of the group alone; then the end
// test (end-test.h) says where its members' arcs really end, once.  Nothing else of it changes.
//
// Where an arc ends a group check stands (integrate/arc/arc-end.h says why it may end); a group at
// rest has none: its members' arcs are constant until something touches one of them.
//
// Not all members of a group need leave it at once: what a blow does to a heap dies away within a
// few bodies, so only these get new arcs, in a group of their own.  It meets the others at its
// border, where they follow the arcs that they have, and joins them again at the check that was due
// (region.h).
//
// Source: the paper, section 4.4; doc/architecture.md, "Contact groups".
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/counted.h"
#include "dynamics/contact-scales.h"
#include "groups/rest/stillness.h"
#include "integrate/arc/group-arc.h"
#include "timeline/key.h"

namespace tw {

// A pair of bodies in contact, one of them of a member: it has no collision checks.  Its contacts
// stand in a row; it may have none (a ghost at a seam).
struct ContactPair {
  std::uint64_t id = 0;  // pair_id of the bodies
  std::uint32_t first = 0, count = 0;
  bool has_borne_load = false;  // since the two came together
  MassRange masses;             // of all that hung together with them since: their law is for these

  BodyId a() const { return first_of(id); }
  BodyId b() const { return second_of(id); }
  BodyId other(BodyId body) const { return a() == body ? b() : a(); }
};

// Which features of which bodies meet at a contact: how it is found again after a refresh.
struct ContactTag {
  BodyId reference = 0, other = 0;  // a and b of the contact
  int parts = 0;                    // pair of parts
  std::uint64_t feature = 0;
  double flatness = 0, beyond = 0;  // collision/manifold/manifold.h
};

struct Group : Counted<Group> {
  Key key;                      // of the discontinuity that made it
  double placed_at = -never;    // when the last of them was put where it is, s (placed-loads.h)
  ArcEnd planned;               // of the arc, as it was made (planned-end.h)
  std::optional<ArcEnd> found;  // by the end test, once: of the arc as a whole
  bool at_rest = false;
  double first_step = 0;           // of the arc, s; 0: chosen
  double patience = never;         // how long an arc may be worth making, s (planned-end.h)
  int doublings = 0;               // of the time to its next check (foreseen.h)
  MassRange masses;                // of all that hung together when it was made
  std::vector<ProcessId> members;  // ascending
  std::vector<BodyId> outside;     // of arc->start().outside: all in contact that are no members
  bool has_border = false;         // some of them are dynamic
  std::vector<ContactPair> pairs;  // ascending
  std::vector<std::uint32_t> pair_starts, pairs_by_member;  // numbers of each member's, in rows
  std::vector<ContactTag> tags;                             // of arc->start().contacts
  std::vector<double> gaps;          // m, of arc->start().contacts, at the start
  std::vector<Stillness> stillness;  // of each member, while it moves
  std::shared_ptr<GroupArc> arc;

  // Its place among the members; -1: it is none.
  int member_of(ProcessId process) const {
    const auto at = std::lower_bound(members.begin(), members.end(), process);
    return at != members.end() && *at == process ? static_cast<int>(at - members.begin()) : -1;
  }
  bool contains(ProcessId process) const { return member_of(process) >= 0; }
  // Null if the two are not in contact here.
  const ContactPair* find(std::uint64_t pair) const {
    const auto at =
        std::lower_bound(pairs.begin(), pairs.end(), pair,
                         [](const ContactPair& known, std::uint64_t id) { return known.id < id; });
    return at != pairs.end() && at->id == pair ? &*at : nullptr;
  }
  // The numbers of a member's contact pairs.
  std::span<const std::uint32_t> pairs_of(std::uint32_t member) const {
    const std::uint32_t first = pair_starts[member];
    return {pairs_by_member.data() + first, pair_starts[member + 1] - first};
  }
  // When its contacts are looked at for what holds at `when`: resting ones at their start alone.
  double contact_time(double when) const { return at_rest ? arc->start().time : when; }
  // The gap up to which a contact presses, but for the law's own depth, m, >= 0.
  double reach_of(std::uint32_t contact) const {
    return std::max(arc->start().contacts[contact].offset, 0.0);
  }
  ContactForce contact_at(std::uint32_t contact, double when) const {
    return arc->contact_force(static_cast<int>(contact), contact_time(when));
  }
  // The same, cheaper where few of its contacts are asked for at that instant.
  ContactForce lone_contact_at(std::uint32_t contact, double when) const {
    return arc->lone_contact_force(static_cast<int>(contact), contact_time(when));
  }
  // Where the arc ends, as far as that is known: there its next check stands.
  const ArcEnd& end() const { return found ? *found : planned; }
  double next_check() const { return end().time; }
  // The same as a discontinuity at `now` may know it: of a group that was made at that very instant
  // what was planned, for whether its end was looked for by then hangs on the schedule.
  double next_check_at(double now) const { return key.time < now ? next_check() : planned.time; }
  // Where the arc of a member ends by itself: of a large group some may end before its check.
  ArcEnd end_of(std::uint32_t member) const {
    const std::vector<ArcEnd>& ends = arc->found_ends();
    return ends.empty() ? end() : ends[member];
  }
  bool ended_early() const { return found && found->time < planned.time; }
};

using Groups = std::vector<std::shared_ptr<Group>>;

// Each once, in an order that hangs on what they are: of one discontinuity no two have a member in
// common.
inline void sort_once(Groups& groups) {
  std::sort(groups.begin(), groups.end(), [](const auto& x, const auto& y) {
    return x->key < y->key || (x->key == y->key && x->members.front() < y->members.front());
  });
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
}

inline void add_once(Groups& groups, const std::shared_ptr<Group>& group) {
  if (group && std::find(groups.begin(), groups.end(), group) == groups.end())
    groups.push_back(group);
}

// Calls visit(c) for each contact of the pair.
template <class Visit>
void each_contact(const ContactPair& pair, Visit&& visit) {
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) visit(c);
}

}  // namespace tw
