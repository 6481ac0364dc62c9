// Regions: which bodies a discontinuity gives new arcs.
//
// What happens to one body of a heap moves others the less the farther away they are: the next few
// feel it, the hundredth does not before the next group check.  So a discontinuity gives new arcs
// to the bodies it concerns and to those that touch them.  What these meet at their border follows
// the arcs that it has; but where it would miss an impulse that changes its velocity by more than a
// share of what a step of the integrator may be wrong by (at rest: a force of a share of its
// weight), it is taken in too, until nobody at the border would notice.  At the group check that
// was due all join again.
//
// Both arcs of a border's contact hold the same features; the group that was made last has the say
// in it. States at the border are recorded, so that a rollback of theirs takes those back that
// relied on them.
//
// Measured: a blow on a heap of 90 sliding rocks moves 4 to 6 of them by more than
// 1 mm/s before the next check.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/region.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {
namespace {

// What rests at the border wakes where the force on it changes by this share of its weight.
constexpr double wake_share = 0.02;
// What moves there may miss this share of a step's velocity tolerance, for what is missed is lost
// to the body's momentum.  Where the tolerance was 0.01 sqrt(g size) a row of 16 cubes ended
// with 2.8 times its momentum with all of it, with 0.9 % too much with this share (with a tenth 1.0
// %, at 1.3 times the cost).
constexpr double missed_share = 0.3;

void insert(std::vector<BodyId>& ids, BodyId id) {
  const auto at = std::lower_bound(ids.begin(), ids.end(), id);
  if (at == ids.end() || *at != id) ids.insert(at, id);
}

bool holds(const std::vector<BodyId>& ids, BodyId id) {
  return std::binary_search(ids.begin(), ids.end(), id);
}

// Whether a link carries a load at `when`.
bool carries(const Group& group, const ContactPair& pair, double when) {
  when = group.contact_time(when);
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
    if (group.arc->contact_force(static_cast<int>(c), when).gap <= 0) return true;
  return false;
}

// The force of a link on one of its bodies, N.
Vec3 force_on(BodyId body, const Group& group, const ContactPair& pair, double when) {
  when = group.contact_time(when);
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
    const ContactForce f = group.arc->contact_force(static_cast<int>(c), when);
    const Vec3 force = f.normal_force * f.normal + f.friction;
    sum += group.tags[c].other == body ? force : Vec3(-force);
  }
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

}  // namespace

// The group whose links tell whether two bodies in these states are in contact; null: they are not.
const Group* Kernel::owner_of(const State& a, const State& b) const {
  if (!body_of(b.process).dynamic()) return a.group.get();
  if (!body_of(a.process).dynamic()) return b.group.get();
  // of one discontinuity: the one that moves
  if (a.arc_key == b.arc_key) return (a.group && !a.group->at_rest ? a : b).group.get();
  return (a.arc_key < b.arc_key ? b : a).group.get();
}

// Those of its members that have not left it before `key`.
std::vector<BodyId> Kernel::remaining(const Group& group, const Key& key) const {
  std::vector<BodyId> result;
  for (const BodyId id : group.members)
    if (const State& s = *graph.last_before(process_of(id), key);
        s.group.get() == &group && !s.error)
      result.push_back(id);
  return result;
}

// The dynamic bodies linked to bodies of the region, with what stands before `key`: calls back with
// the group that has the say, the link, the body inside and the other one.
template <class Visit>
void Kernel::visit_contacts(const std::vector<BodyId>& inside, const Key& key, Visit visit) const {
  for (const BodyId id : inside) {
    const State& state = *graph.last_before(process_of(id), key);
    const Group* group = state.group.get();
    if (!group || state.error) continue;
    for (const std::uint32_t number : group->pairs_of(state.member)) {
      const ContactPair& pair = group->pairs[number];
      const BodyId other = first_of(pair.id) == id ? second_of(pair.id) : first_of(pair.id);
      if (!bodies[other]->dynamic()) continue;
      const State& theirs = *graph.last_before(process_of(other), key);
      const Group* owner = owner_of(state, theirs);
      const ContactPair* standing = owner == group ? &pair : owner ? owner->find(pair.id) : nullptr;
      if (standing && !theirs.error) visit(*owner, *standing, other);
    }
  }
}

// The region of a discontinuity that concerns the dynamic bodies `hit`.
Region Kernel::region_of(const Key& key, const std::vector<BodyId>& struck, bool whole) const {
  Region region;
  region.inside = struck;
  if (!whole) add_neighbours(region, key);
  complete(region, key, whole);
  return region;
}

// Those that touch the region and move; what rests wakes where it notices (reached_beyond).
void Kernel::add_neighbours(Region& region, const Key& key) const {
  std::vector<BodyId> next;
  visit_contacts(region.inside, key,
                 [&](const Group& owner, const ContactPair& pair, BodyId other) {
                   const auto& theirs = graph.last_before(process_of(other), key)->group;
                   const bool rests = theirs && theirs->at_rest;
                   if (!rests && !holds(region.inside, other) && carries(owner, pair, key.time))
                     next.push_back(other);
                 });
  for (const BodyId id : next) insert(region.inside, id);
}

// These, and all dynamic bodies that they reach by links over bodies of which `goes_on` holds;
// ascending.
template <class GoesOn>
std::vector<BodyId> Kernel::reached_from(const std::vector<BodyId>& ids, const Key& key,
                                         GoesOn goes_on) const {
  std::vector<BodyId> all, next;
  for (const BodyId id : ids) insert(all, id);
  for (next = all; !next.empty();) {
    std::vector<BodyId> found;
    visit_contacts(next, key, [&](const Group&, const ContactPair&, BodyId other) {
      if (!holds(all, other) && goes_on(*graph.last_before(process_of(other), key)))
        insert(found, other);
    });
    for (const BodyId id : found) insert(all, id);
    next = found;
  }
  return all;
}

// These, and all provisional sleepers that hang together with them.
std::vector<BodyId> Kernel::all_asleep(const std::vector<BodyId>& ids, const Key& key) const {
  return reached_from(ids, key, [](const State& s) { return s.group && s.group->asleep; });
}

// The body, and all that it is linked to over any number of others.
std::vector<BodyId> Kernel::hanging_together(BodyId id, const Key& key) const {
  return reached_from({id}, key, [](const State&) { return true; });
}

// Whether something that moves touches the sleepers; `movers`: those of them that keep their arcs.
bool Kernel::disturbed(const Regrouping& work, const std::vector<BodyId>& asleep,
                       std::vector<BodyId>& in_motion) const {
  bool found = false;
  visit_contacts(asleep, work.key, [&](const Group&, const ContactPair& pair, BodyId other) {
    if (holds(asleep, other) || pair.count == 0) return;
    const Successor* successor = work.successor_of(other);
    const bool changes = work.changes(successor);
    const Group* group =
        (changes ? successor->data : *graph.last_before(process_of(other), work.key)).group.get();
    if (!group || group->at_rest) return;
    found = true;
    if (!changes) insert(in_motion, other);
  });
  return found;
}

// Small groups whole, and the border.  What this depends on stands in states of the region and its
// border: so nothing here may ask how many have left a large group.
void Kernel::complete(Region& region, const Key& key, bool whole) const {
  Groups groups;
  for (const BodyId id : region.inside)
    add_once(groups, graph.last_before(process_of(id), key)->group);
  for (const auto& group : groups)
    if (whole || group->members.size() < least_divided)
      for (const BodyId id : remaining(*group, key)) insert(region.inside, id);

  region.border.clear();
  visit_contacts(region.inside, key, [&](const Group&, const ContactPair&, BodyId other) {
    if (!holds(region.inside, other)) insert(region.border, other);
  });
}

// Whether the body's arc ends at the time of the key, and the check that stands there comes first.
bool Kernel::own_check_before(BodyId id, const Key& key) const {
  if (!bodies[id]->dynamic()) return false;
  const State& tail = *graph.tail(process_of(id));
  if (tail.error || tail.trajectory().end() != key.time) return false;
  Key check = group_check_key(*tail.group, key.time);
  check.id = id;
  return tail.key < check && check < key;
}

// Claims windows of a body until its arcs are known to `key`.  False: something else comes first,
// perhaps.
bool Kernel::await(BodyId id, const Key& key) {
  Body& body = *bodies[id];
  // checks and callbacks come before the impacts of their instant
  const bool at_time = key.kind == KeyKind::group_check || key.kind == KeyKind::callback;
  const auto known = [&] {
    return at_time ? process(body).claim.time >= key.time : ready(body, key);
  };
  bool all_known = true;
  // its own check of this instant would be forgotten if its arc were changed by a greater key
  if (at_time && own_check_before(id, key)) {
    process_group_check(id);
    return false;
  }
  while (!body.fixed() && !known() && !graph.tail(process_of(id))->error) {
    all_known = false;
    if (process(body).claim.time < graph.tail(process_of(id))->trajectory().end()) {
      claim_window(body);
      continue;
    }
    // first the group check that stands before it
    process_group_check(id);
    break;
  }
  return all_known;
}

bool Kernel::await(const Region& region, const Key& key) {
  bool all_known = true;
  for (const BodyId id : region.inside) all_known = await(id, key) && all_known;
  for (const BodyId id : region.border) all_known = await(id, key) && all_known;
  for (const BodyId id : region.depends_on) all_known = await(id, key) && all_known;
  return all_known;
}

// How far a member's new arc takes it from the old one by the end, as a speed, m/s.
double Kernel::deviation(const Group& group, BodyId id) const {
  const State& before = *graph.last_before(process_of(id), group.key);
  if (!before.group) return never;
  const Body& body = *bodies[id];
  const double end = group.arc->reached();
  const GroupSample now = group.arc->evaluate(group.member_of(id), end);
  // an arc that began at this very instant need not be complete
  if (!before.group->at_rest) before.group->arc->extend(end);
  const PoseTwist was = before.trajectory().at(end);
  return (now.v - was.v).norm() + (now.w - was.w).norm() * body.radius;
}

// Bodies at the border that would notice: what touches them moves otherwise than their arcs assume,
// or, where they rest, the force on them has changed.
std::vector<BodyId> Kernel::reached_beyond(const Regrouping& work) const {
  std::vector<BodyId> more;
  const auto lies_beyond = [&](BodyId id) {
    return bodies[id]->dynamic() && !work.changes(work.successor_of(id));
  };
  const auto wakes = [&](BodyId id, const Vec3& change) {
    return change.norm() > wake_share * (gravity_magnitude() * bodies[id]->mass);
  };
  for (const auto& group : work.made) {
    if (!group->has_border) continue;
    if (!group->at_rest) group->arc->extend(group->next_check);
    const double end = group->arc->reached();
    for (const ContactPair& pair : group->pairs) {
      const BodyId a = first_of(pair.id), b = second_of(pair.id);
      const BodyId other = lies_beyond(a) ? a : b, mine = other == a ? b : a;
      if (!lies_beyond(other)) continue;
      const std::shared_ptr<Group>& theirs = work.successor_of(other)->data.group;
      if (theirs->at_rest) {
        const ContactPair* known = theirs->find(pair.id);
        const Vec3 before = known ? force_on(other, *theirs, *known, end) : Vec3(Vec3::Zero());
        if (wakes(other, force_on(other, *group, pair, end) - before)) more.push_back(other);
        continue;
      }
      // the impulse only where the neighbour's motion could have changed it
      const double tolerance = missed_share * group->arc->start().velocity_tolerance;
      if (deviation(*group, mine) > tolerance &&
          missed_impulse(other, *group, pair, *theirs).norm() > tolerance * bodies[other]->mass)
        more.push_back(other);
    }
  }
  // what rests and has lost a support
  for (const PairBefore& old : work.before) {
    const BodyId a = first_of(old.id), b = second_of(old.id);
    const BodyId other = lies_beyond(a) ? a : b;
    if (!lies_beyond(other)) continue;
    const std::shared_ptr<Group>& theirs = work.successor_of(other)->data.group;
    if (!theirs || !theirs->at_rest) continue;
    const auto standing = std::find_if(work.pairs.begin(), work.pairs.end(),
                                       [&](const NewContactPair& l) { return l.id == old.id; });
    const ContactPair* known = theirs->find(old.id);
    if (standing != work.pairs.end() || !known) continue;
    if (wakes(other, force_on(other, *theirs, *known, 0))) more.push_back(other);
  }
  return more;
}

// Arcs that were integrated to no end.
void Kernel::discard(const Regrouping& work) {
  for (const auto& group : work.made) {
    if (group->at_rest) continue;
    const GroupCounts counts = group->arc->counts();
    counters.integrations += counts.steps;
    counters.implicit_steps += counts.steps;
    counters.rejected_steps += counts.rejected;
    counters.factorizations += counts.factorizations;
    counters.force_evaluations += counts.evaluations;
    counters.integration_length += static_cast<double>(group->members.size()) *
                                   (group->arc->reached() - group->arc->start().time);
  }
}

// The drafts of a region: those given as they are, with new arcs for all inside.
std::vector<Successor> Kernel::make_successors(const Region& region, const Key& key,
                                               const std::vector<Successor>& given) const {
  std::vector<Successor> all = given;
  const auto known = [&](BodyId id) {
    for (Successor& successor : all)
      if (successor.body->id() == id) return &successor;
    return static_cast<Successor*>(nullptr);
  };
  all.reserve(given.size() + region.inside.size() + region.border.size());
  for (const BodyId id : region.inside) {
    Successor* successor = known(id);
    if (!successor)
      all.push_back(make_successor(*bodies[id], key, true));
    else if (!successor->starts_arc())
      start_new_arc(*successor, key);
  }
  for (const BodyId id : region.border) {
    if (known(id)) continue;
    all.push_back(make_successor(*bodies[id], key, false));
    all.back().data.changed = false;
    all.back().role = Role::border;
  }
  for (const BodyId id : region.depends_on) {
    if (holds(region.border, id) || known(id)) continue;
    all.push_back(make_successor(*bodies[id], key, false));
    all.back().data.changed = false;
    all.back().role = Role::dependence;
  }
  return all;
}

bool Kernel::touches_groups(const std::vector<Successor>& successors) const {
  return std::any_of(successors.begin(), successors.end(), [&](const Successor& successor) {
    return successor.starts_arc() && successor.data.group;
  });
}

// After an edit between runs.
void Kernel::regroup_edited(const Key& key, std::vector<Successor>& successors) {
  if (touches_groups(successors)) regroup(key, successors, Cause::edit);
}

// The groups that follow a discontinuity that changed some of the drafts; adds drafts of all others
// that take part.  False: something may come first, and nothing has been done.
bool Kernel::regroup(const Key& key, std::vector<Successor>& successors, Cause cause) {
  std::vector<BodyId> struck;
  for (const Successor& successor : successors)
    if (successor.starts_arc()) insert(struck, successor.body->id());
  const bool between_runs = is_edit(key);

  Region region = region_of(key, struck, cause == Cause::edit);
  for (;;) {
    if (!between_runs && !await(region, key)) return false;
    std::vector<Successor> all = make_successors(region, key, successors);
    Regrouping work(key, all);
    work.may_sleep = cause == Cause::check;
    work.falls_asleep = !region.depends_on.empty();
    collect_old(work);
    if (finds_contacts(cause))
      refresh(work, struck, check_interval(work, struck));
    else
      for (const PairBefore& old : work.before) carry(work, old);
    if (cause == Cause::fusion) {
      find_fixed_around(successors[0].body->dynamic() ? *successors[0].body : *successors[1].body);
      connect(work, placed(all[0]), placed(all[1]), check_interval(work, struck), true);
      work.tally.fusions = 1;
    }
    std::vector<BodyId> more;
    if (passes_impulses(cause)) more = propagate_impulses(work);
    if (more.empty()) {
      finish(work);
      more = reached_beyond(work);
      const std::vector<BodyId> asleep = all_asleep(asleep_around(work), key);
      if (std::vector<BodyId> in_motion; more.empty() && disturbed(work, asleep, in_motion)) {
        // what would come to rest with them goes to sleep instead
        discard(work);
        region.depends_on = asleep;
        region.depends_on.insert(region.depends_on.end(), in_motion.begin(), in_motion.end());
        continue;
      }
      more.insert(more.end(), asleep.begin(), asleep.end());
    }
    if (more.empty()) {
      for (const auto& group : work.made) count_group(*group);
      successors = std::move(all);
      return true;
    }
    discard(work);
    region.depends_on.clear();
    for (const BodyId id : more) insert(region.inside, id);
    add_neighbours(region, key);
    complete(region, key, false);
  }
}

}  // namespace tw
