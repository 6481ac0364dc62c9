// Regions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/region.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "groups/joined.h"

namespace tw {
namespace {

// Whether a contact pair carries a load at `when`.
bool carries(const Group& owner, const ContactPair& pair, double when) {
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
    if (owner.contact_at(c, when).gap <= owner.reach_of(c)) return true;
  return false;
}

// The force of a pair on one of its bodies, N.
Vec3 force_on(BodyId body, const Group& owner, const ContactPair& pair, double when) {
  Vec3 sum = Vec3::Zero();
  each_contact(pair, [&](std::uint32_t c) {
    const ContactForce f = owner.contact_at(c, when);
    const Vec3 force = f.normal_force * f.normal + f.friction;
    sum += owner.tags[c].other == body ? force : Vec3(-force);
  });
  return sum;
}

// The same with its torque about the body's centre of mass, N m.
Wrench load_on(const Body& body, const Vec3& centre, const Group& owner, const ContactPair& pair,
               double when) {
  Wrench sum;
  each_contact(pair, [&](std::uint32_t c) {
    const ContactForce f = owner.contact_at(c, when);
    const double sign = owner.tags[c].other == body.id() ? 1 : -1;
    const Vec3 force = sign * (f.normal_force * f.normal + f.friction);
    sum.force += force;
    sum.torque += (f.point - centre).cross(force) + sign * f.torque;
  });
  return sum;
}

// What `group` gives a body at its border and the body's own group does not know of, N s: Simpson's
// rule over the steps.
Vec3 missed_impulse(BodyId body, const Group& group, const ContactPair& pair, const Group& theirs) {
  const ContactPair* known = theirs.find(pair.id);
  const auto missed = [&](double when) {
    const Vec3 force = force_on(body, group, pair, when);
    return known ? Vec3(force - force_on(body, theirs, *known, when)) : force;
  };
  Vec3 sum = Vec3::Zero();
  double from = group.arc->start().time;
  Vec3 first = missed(from);
  while (from < group.arc->reached()) {
    const double to = group.arc->step_end(from);
    const Vec3 middle = missed(0.5 * (from + to)), last = missed(to);
    sum += (to - from) / 6 * (first + 4 * middle + last);
    from = to;
    first = last;
  }
  return sum;
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

// Whether the body beyond a new group's border notices what it does at their contact.
bool notices(Regrouping& work, const Group& group, const ContactPair& pair, const Body& body,
             const Body& member) {
  const Group& theirs = *work.successor_of(body.process)->data.group;
  if (theirs.at_rest) {
    const double end = group.arc->reached();
    const ContactPair* known = theirs.find(pair.id);
    const Vec3 centre = work.successor_of(body.process)->point.x;
    Wrench change = load_on(body, centre, group, pair, end);
    if (known) {
      const Wrench before = load_on(body, centre, theirs, *known, end);
      change.force -= before.force;
      change.torque -= before.torque;
    }
    return wakes(work, body, change, lever_of(body, group, pair));
  }
  // the impulse only where the neighbour's motion could have changed it
  const double tolerance = answer::missed_share * group.arc->start().velocity_tolerance;
  if (!(deviation(work.before, group, member) > tolerance)) return false;
  const double missed = missed_impulse(body.id(), group, pair, theirs).norm();
  if (missed > tolerance * body.mass) return true;
  work.tally.momentum_dropped += missed;
  return false;
}

// Whether what rests has lost a support that carried it.
bool misses(const Regrouping& work, const PairBefore& old, const Body& body) {
  const std::shared_ptr<Group>& theirs = work.successor_of(body.process)->data.group;
  if (!theirs || !theirs->at_rest) return false;
  const auto standing = std::find_if(work.pairs.begin(), work.pairs.end(),
                                     [&](const ContactPair& p) { return p.id == old.id; });
  const ContactPair* known = theirs->find(old.id);
  if (standing != work.pairs.end() || !known) return false;
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

std::vector<ProcessId> who_notices(Regrouping& work) {
  const Scene& scene = work.scene();
  std::vector<ProcessId> found;
  for (const auto& group : work.made) {
    if (!group->has_border) continue;
    if (!group->at_rest) group->arc->extend_patiently(group->next_check);
    for (const ContactPair& pair : group->pairs) {
      const BodyId other = work.lies_beyond(pair.a()) ? pair.a() : pair.b();
      if (!work.lies_beyond(other)) continue;
      const Body& body = scene.body(other);
      if (notices(work, *group, pair, body, scene.body(pair.other(other))))
        found.push_back(body.process);
    }
  }
  for (const PairBefore& old : work.pairs_before) {
    const BodyId other = work.lies_beyond(old.pair->a()) ? old.pair->a() : old.pair->b();
    if (!work.lies_beyond(other)) continue;
    const Body& body = scene.body(other);
    if (misses(work, old, body)) found.push_back(body.process);
  }
  return found;
}

}  // namespace tw
