// Regions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regroup/region.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "groups/joints/joined.h"

namespace tw {
namespace {

// Whether a contact pair carries a load at `when`.
bool carries(const Group& owner, const ContactPair& pair, double when) {
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
    if (owner.lone_contact_at(c, when).gap <= owner.reach_of(c)) return true;
  return false;
}

// The force of a pair on one of its bodies, N.
Vec3 force_on(BodyId body, const Group& owner, const ContactPair& pair, double when) {
  Vec3 sum = Vec3::Zero();
  each_contact(pair, [&](std::uint32_t c) {
    sum += owner.lone_contact_at(c, when).force_on(owner.tags[c].other == body);
  });
  return sum;
}

// The same with its torque about the body's centre of mass, N m.
Wrench load_on(const Body& body, const Vec3& centre, const Group& owner, const ContactPair& pair,
               double when) {
  Wrench sum;
  each_contact(pair, [&](std::uint32_t c) {
    const bool is_other = owner.tags[c].other == body.id();
    const Wrench load = owner.lone_contact_at(c, when).wrench_on(is_other, centre);
    sum.force += load.force;
    sum.torque += load.torque;
  });
  return sum;
}

// A moving body beyond a new group's border, and its contact with a member.
struct Neighbour {
  const Body* body;
  const ContactPair* pair;
  const Group* theirs;
  const ContactPair* known;  // the contact as `theirs` has it; null: it has none
};

// The ends and middles of an arc's steps, s.
std::vector<double> nodes_of(const GroupArc& arc) {
  std::vector<double> nodes{arc.start().time};
  while (nodes.back() < arc.reached()) {
    const double from = nodes.back(), to = arc.step_end(from);
    nodes.push_back(0.5 * (from + to));
    nodes.push_back(to);
  }
  return nodes;
}

// What `group` gives each of these and their own groups do not know of, N s: Simpson's rule over
// its steps.  All contacts at one instant, then the next, as an arc keeps what it is asked for.
std::vector<Vec3> missed_impulses(const Group& group, const std::vector<Neighbour>& neighbours) {
  const std::vector<double> nodes = nodes_of(*group.arc);
  const std::size_t count = nodes.size();
  std::vector<Vec3> missed(neighbours.size() * count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < neighbours.size(); ++i)
      missed[i * count + k] =
          force_on(neighbours[i].body->id(), group, *neighbours[i].pair, nodes[k]);
  std::vector<const Group*> seen;
  for (const Neighbour& first : neighbours) {
    if (!first.known || std::find(seen.begin(), seen.end(), first.theirs) != seen.end()) continue;
    seen.push_back(first.theirs);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < neighbours.size(); ++i)
        if (const Neighbour& n = neighbours[i]; n.known && n.theirs == first.theirs)
          missed[i * count + k] -= force_on(n.body->id(), *n.theirs, *n.known, nodes[k]);
  }
  std::vector<Vec3> sums;
  sums.reserve(neighbours.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const Vec3* force = &missed[i * count];
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k + 2 < count; k += 2)
      sum += (nodes[k + 2] - nodes[k]) / 6 * (force[k] + 4 * force[k + 1] + force[k + 2]);
    sums.push_back(sum);
  }
  return sums;
}

// How far a member's new arc takes it from the old one by the end, as a speed, m/s.
double deviation(const Before& before, const Group& group, const Body& body) {
  const State& old = before.state(body.process);
  if (!old.group) return never;
  double end = group.arc->reached();
  // an arc that began at this very instant need not be complete
  if (!old.group->at_rest) {
    old.group->arc->extend_patiently(end);
    end = std::min(end, old.group->arc->last());
  }
  const GroupSample now = group.arc->evaluate(group.member_of(body.process), end);
  const PoseTwist was = old.trajectory().at(end);
  return (now.v - was.v).norm() + (now.w - was.w).norm() * body.radius;
}

// Those that touch `outmost` and move, then those that touch these, until `enough` are inside; what
// rests wakes where it notices.
void add_neighbours(Region& region, const Before& before, std::vector<ProcessId> outmost,
                    std::size_t enough) {
  do {
    std::vector<ProcessId> next;
    before.visit_contacts(outmost, [&](const Group& owner, const ContactPair& pair, BodyId other) {
      const State& theirs = before.state_of(other);
      const bool rests = theirs.group && theirs.group->at_rest;
      if (rests || holds(region.inside, theirs.process)) return;
      if (carries(owner, pair, before.key().time)) insert(next, theirs.process);
    });
    for (const ProcessId process : next) insert(region.inside, process);
    outmost = std::move(next);
  } while (!outmost.empty() && region.inside.size() < enough);
}

// Small groups whole, and the border.  What this depends on stands in states of the region and its
// border: so nothing here may ask how many have left a large group.
void complete(Region& region, const Before& before, bool whole) {
  add_joined(before, region.inside);
  Groups groups;
  for (const ProcessId process : region.inside) add_once(groups, before.state(process).group);
  for (const auto& group : groups)
    if (whole || group->members.size() < answer::least_divided)
      for (const ProcessId process : before.remaining(*group)) insert(region.inside, process);
  add_joined(before, region.inside);

  region.border.clear();
  before.visit_contacts(region.inside, [&](const Group&, const ContactPair&, BodyId other) {
    const ProcessId process = before.scene().process_of(other);
    if (!holds(region.inside, process)) insert(region.border, process);
  });
}

// The lever at which a torque counts as much as a force does, m: half the body's width, or the
// length by which the pair resists rolling or spinning, for what balances such a torque is no more
// than that times the weight.
double lever_of(const Body& body, const Group& owner, const ContactPair& pair) {
  double lever = 0.5 * body.least_width;
  each_contact(pair, [&](std::uint32_t c) {
    const ContactConstants& law = owner.arc->start().contacts[c].law;
    if (const double length = std::max(law.rolling, law.spinning); length > 0)
      lever = std::min(lever, length);
  });
  return lever;
}

bool wakes(const Regrouping& work, const Body& body, const Wrench& change, double lever) {
  const double least = answer::wake_share * (work.scene().gravity_scale() * body.mass);
  return change.force.norm() > least || change.torque.norm() > least * lever;
}

// Whether what rests beyond a new group's border notices what it does at their contact.
bool is_woken(const Regrouping& work, const Group& group, const ContactPair& pair,
              const Body& body) {
  const Successor& successor = *work.successor_of(body.process);
  const Group& theirs = *successor.data.group;
  const double end = group.arc->reached();
  Wrench change = load_on(body, successor.point.x, group, pair, end);
  if (const ContactPair* known = theirs.find(pair.id)) {
    const Wrench before = load_on(body, successor.point.x, theirs, *known, end);
    change.force -= before.force;
    change.torque -= before.torque;
  }
  return wakes(work, body, change, lever_of(body, group, pair));
}

// Adds those beyond a new group's border that notice what it does at their contacts.
void add_noticing(const Regrouping& work, const Group& group, Noticed& noticed) {
  // the impulse only where the neighbour's motion could have changed it
  const double tolerance = answer::missed_share * group.arc->start().velocity_tolerance;
  std::vector<Neighbour> moving;
  for (const ContactPair& pair : group.pairs) {
    const BodyId other = work.lies_beyond(pair.a()) ? pair.a() : pair.b();
    if (!work.lies_beyond(other)) continue;
    const Body& body = work.scene().body(other);
    const Group& theirs = *work.successor_of(body.process)->data.group;
    if (!theirs.at_rest) {
      if (deviation(work.before, group, work.scene().body(pair.other(other))) > tolerance)
        moving.push_back({&body, &pair, &theirs, theirs.find(pair.id)});
    } else if (is_woken(work, group, pair, body)) {
      noticed.by.push_back(body.process);
    }
  }
  if (moving.empty()) return;
  const std::vector<Vec3> missed = missed_impulses(group, moving);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const double impulse = missed[i].norm();
    if (impulse > tolerance * moving[i].body->mass)
      noticed.by.push_back(moving[i].body->process);
    else
      noticed.momentum_dropped += impulse;
  }
}

// Whether what rests has lost a support that carried it.
bool misses(const Regrouping& work, const Contacts& contacts, const PairBefore& old,
            const Body& body) {
  const std::shared_ptr<Group>& theirs = work.successor_of(body.process)->data.group;
  if (!theirs || !theirs->at_rest) return false;
  const ContactPair* known = theirs->find(old.id);
  if (contacts.find(old.id) || !known) return false;
  const Vec3 centre = work.successor_of(body.process)->point.x;
  return wakes(work, body, load_on(body, centre, *theirs, *known, work.now()),
               lever_of(body, *theirs, *known));
}

}  // namespace

Region region_of(const Before& before, const std::vector<ProcessId>& struck, bool whole) {
  Region region;
  region.inside = struck;
  if (!whole) add_neighbours(region, before, struck, 0);
  complete(region, before, whole);
  return region;
}

void widen(Region& region, const Before& before, const std::vector<ProcessId>& more) {
  const std::size_t enough = answer::region_growth * region.inside.size();
  for (const ProcessId process : more) insert(region.inside, process);
  add_neighbours(region, before, more, enough);
  complete(region, before, false);
}

Noticed who_notices(const Regrouping& work, const Contacts& contacts, const Groups& made) {
  Noticed noticed;
  for (const auto& group : made) {
    if (!group->has_border) continue;
    if (!group->at_rest) group->arc->extend_patiently(group->next_check());
    add_noticing(work, *group, noticed);
  }
  for (const PairBefore& old : work.pairs_before) {
    const BodyId other = work.lies_beyond(old.pair->a()) ? old.pair->a() : old.pair->b();
    if (!work.lies_beyond(other)) continue;
    const Body& body = work.scene().body(other);
    if (misses(work, contacts, old, body)) noticed.by.push_back(body.process);
  }
  return noticed;
}

}  // namespace tw
