// Making groups: gathering the members of old ones, carrying their contacts along, and cutting what
// is linked into new ones.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/regrouping.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "groups/tolerances.h"
#include "integrate/member-trajectory.h"
#include "integrate/standing.h"
#include "kernel/kernel.h"

namespace tw {
namespace {

// Contacts of one body with several fixed ones share one stiffness where their normals agree to
// this, rad.
constexpr double coplanar = 1e-3;
// Where a corner crosses the edge between two faces that meet at a small angle, both hold it for a
// moment: as far as they are at one place (share of the size) with one normal (cosine), they hold
// it together.
constexpr double same_place = 1e-2, same_normal = 0.95;

// Which drafts hang together: roots by path halving.
struct Components {
  std::vector<std::size_t> parent;
  explicit Components(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    i = root(i);
    j = root(j);
    parent[std::max(i, j)] = std::min(i, j);
  }
};

// At rest from here on.
void stop(Successor& successor) {
  successor.point.v = successor.point.w = successor.data.v = successor.data.L = Vec3::Zero();
}

// How much of a point counts: all of it to the depth that one weight makes, less and less to twice
// that above the surface.  Nothing jumps where a point comes near.
double participation(const NewContact& c) {
  return std::clamp(2 - c.gap / c.contact.law.depth, 0.0, 1.0);
}

}  // namespace

Successor* Regrouping::successor_of(BodyId id) const {
  const auto at = std::lower_bound(index.begin(), index.end(), std::pair{id, std::size_t{0}});
  return at != index.end() && at->first == id ? &successors[at->second] : nullptr;
}

void Regrouping::update_index() {
  index.clear();
  for (std::size_t i = 0; i < successors.size(); ++i)
    index.push_back({successors[i].body->id(), i});
  std::sort(index.begin(), index.end());
}

const PairBefore* Regrouping::pair_before(std::uint64_t pair) const {
  const auto at = std::lower_bound(before.begin(), before.end(), pair,
                                   [](const PairBefore& l, std::uint64_t p) { return l.id < p; });
  return at != before.end() && at->id == pair ? &*at : nullptr;
}

// The groups that the drafts come from, and the links of those that get new arcs.
void Kernel::collect_old(Regrouping& work) const {
  work.update_index();
  Groups all;
  for (const auto& [id, i] : work.index) {
    const Successor& successor = work.successors[i];
    if (!successor.body->dynamic() || successor.role == Role::dependence) continue;
    add_once(all, successor.data.group);
    if (!work.changes(&successor)) {
      work.has_border = work.has_border || successor.data.group;
      continue;
    }
    add_once(work.old, successor.data.group);
    work.lightest = std::min(work.lightest, successor.body->mass);
    work.heaviest = std::max(work.heaviest, successor.body->mass);
  }
  if (work.has_border)
    for (const auto& group : all) {
      work.lightest = std::min(work.lightest, group->lightest);
      work.heaviest = std::max(work.heaviest, group->heaviest);
    }

  for (const auto& [id, i] : work.index) {
    const Successor& successor = work.successors[i];
    if (!work.changes(&successor) || !successor.data.group) continue;
    for (const std::uint32_t number : successor.data.group->pairs_of(successor.data.member)) {
      const ContactPair& pair = successor.data.group->pairs[number];
      const State& a = *graph.last_before(process_of(first_of(pair.id)), work.key);
      const State& b = *graph.last_before(process_of(second_of(pair.id)), work.key);
      const Group* owner = owner_of(a, b);
      const ContactPair* standing = owner == successor.data.group.get() ? &pair
                                    : owner                             ? owner->find(pair.id)
                                                                        : nullptr;
      if (standing)
        work.before.push_back({pair.id, owner == a.group.get() ? a.group : b.group, standing});
    }
  }
  std::sort(work.before.begin(), work.before.end(),
            [](const PairBefore& x, const PairBefore& y) { return x.id < y.id; });
  // from either side
  const auto same = [](const PairBefore& x, const PairBefore& y) { return x.id == y.id; };
  work.before.erase(std::unique(work.before.begin(), work.before.end(), same), work.before.end());
}

// A link and its contacts as they stand, stretches evaluated at the key's time.
void Kernel::carry(Regrouping& work, const PairBefore& old) const {
  const ContactPair& pair = *old.pair;
  const Group& group = *old.group;
  const GroupArc& arc = *group.arc;
  const double now = group.contact_time(work.key.time);
  const Successor* a = work.successor_of(first_of(pair.id));
  const Successor* b = work.successor_of(second_of(pair.id));
  if ((a && a->placed) || (b && b->placed)) return;
  // between runs somebody may have set them anew
  const bool renew = is_edit(work.key);
  if (renew && !may_collide(*bodies[first_of(pair.id)], *bodies[second_of(pair.id)])) return;
  work.pairs.push_back(
      {pair.id, static_cast<std::uint32_t>(work.contacts.size()), pair.count, pair.has_borne_load});
  for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
    const int number = static_cast<int>(c);
    const ContactForce f = arc.contact_force(number, now);
    NewContact loose{arc.start().contacts[c], group.tags[c], f.gap, f.normal, f.point};
    loose.contact.stretch = arc.stretch(number, now);
    work.contacts.push_back(loose);
  }
}

// Each point's share of its pair's stiffness: 1 / (points that touch or nearly do), those on
// coplanar neighbours of the ground taken together, and points at one place taken for one.
void Kernel::share_stiffness(Regrouping& work) const {
  std::vector<std::pair<BodyId, std::uint32_t>> on_ground;
  for (const NewContactPair& pair : work.pairs) {
    const bool both = bodies[first_of(pair.id)]->dynamic() && bodies[second_of(pair.id)]->dynamic();
    const BodyId mover =
        bodies[first_of(pair.id)]->dynamic() ? first_of(pair.id) : second_of(pair.id);
    double count = 0;
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
      if (!both) on_ground.push_back({mover, c});
      count += participation(work.contacts[c]);
    }
    for (std::uint32_t c = pair.first; both && c < pair.first + pair.count; ++c)
      work.contacts[c].contact.share = 1 / std::max(1.0, count);
  }

  std::sort(on_ground.begin(), on_ground.end());
  for (std::size_t i = 0, j = 0; i < on_ground.size(); i = j) {
    for (j = i; j < on_ground.size() && on_ground[j].first == on_ground[i].first;) ++j;
    std::vector<NewContact*> points;
    for (std::size_t k = i; k < j; ++k) points.push_back(&work.contacts[on_ground[k].second]);
    share_ground_stiffness(points, on_ground[i].first);
  }
}

// With m_i the points at the place of i, itself among them, and n_i the places in its plane: 1 /
// (n_i m_i).
void Kernel::share_ground_stiffness(const std::vector<NewContact*>& points, BodyId mover) const {
  const double radius = same_place * bodies[mover]->least_width;
  // seen from the ground all normals point the same way
  const auto cosine = [&](const NewContact& x, const NewContact& y) {
    const double sign = (x.tag.reference == mover) == (y.tag.reference == mover) ? 1 : -1;
    return sign * x.normal.dot(y.normal);
  };
  std::vector<double> here(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i == j || !(cosine(*points[i], *points[j]) > same_normal)) continue;
      const double distance = (points[i]->point - points[j]->point).norm();
      here[i] += participation(*points[j]) * std::max(0.0, 1 - distance / radius);
    }
  for (std::size_t i = 0; i < points.size(); ++i) {
    double places = 0;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (i == j || cosine(*points[i], *points[j]) > 1 - 0.5 * coplanar * coplanar)
        places += participation(*points[j]) / here[j];
    points[i]->contact.share = 1 / std::max(1.0, places * here[i]);
  }
}

// The motion of a body that a group meets.
TrajectoryPtr Kernel::outside_motion(const Regrouping& work, BodyId id) const {
  if (!bodies[id]->dynamic()) return bodies[id]->motion;
  const Successor& successor = *work.successor_of(id);
  // laid to rest by this discontinuity, or, seen from there, what goes on: it is not asked for long
  if (work.changes(&successor)) return make_standing({successor.point.x, successor.point.q});
  const Group& theirs = *successor.data.group;
  if (theirs.at_rest) return successor.data.follows;
  // a copy of what the new group will see of it: a group that kept those at its border, and these
  // theirs, would keep all there ever were
  theirs.arc->extend(theirs.next_check);
  return theirs.arc->excerpt(static_cast<int>(successor.data.member), work.key.time,
                             theirs.next_check);
}

// Bodies, outside bodies and contacts as the integrator wants them.
void Kernel::start_arc_of(Group& group, Regrouping& work) const {
  GroupStart start;
  start.time = work.key.time;
  start.end = group.next_check;
  double size = never, speed = 0;
  for (const BodyId id : group.members) {
    const Successor& successor = *work.successor_of(id);
    const Body& body = *successor.body;
    const StateData& d = successor.data;
    start.members.push_back({body.mass, body.moments, body.radius, d.x, d.q, d.v, d.L,
                             body.mass * d.acceleration, Vec3::Zero()});
    size = std::min(size, body.least_width);
    const PlacedBody side = placed(successor);
    speed = std::max(speed, side.surface_speed());
  }
  const double closeness =
      group_closeness(options.accuracy, speed / std::sqrt(gravity_magnitude() * size));
  start.position_tolerance = closeness * group_position_tolerance(options.accuracy, size);
  start.velocity_tolerance =
      closeness * group_velocity_tolerance(options.accuracy, size, gravity_magnitude());

  const auto index_of = [&](BodyId id) {
    if (const int member = group.member_of(id); member >= 0) return member;
    const auto known = std::find(group.outside.begin(), group.outside.end(), id);
    if (known != group.outside.end()) return ~static_cast<int>(known - group.outside.begin());
    group.outside.push_back(id);
    start.outside.push_back(outside_motion(work, id));
    return ~static_cast<int>(group.outside.size() - 1);
  };
  for (ContactPair& pair : group.pairs) {
    const std::uint32_t first = static_cast<std::uint32_t>(start.contacts.size());
    const ContactConstants law = contact_law(
        *bodies[first_of(pair.id)], *bodies[second_of(pair.id)], group.lightest, group.heaviest);
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c) {
      NewContact& loose = work.contacts[c];
      loose.contact.law = law;
      loose.contact.a = index_of(loose.tag.reference);
      loose.contact.b = index_of(loose.tag.other);
      start.contacts.push_back(loose.contact);
      group.tags.push_back(loose.tag);
      group.gaps.push_back(loose.gap);
      pair.has_borne_load = pair.has_borne_load || loose.gap < 0;
    }
    pair.first = first;
  }
  // also what is linked without a contact is looked at along the arc (end-test.cc)
  for (const ContactPair& pair : group.pairs)
    for (const BodyId id : {first_of(pair.id), second_of(pair.id)}) index_of(id);
  start.first_step = group.first_step;
  group.arc = std::make_shared<GroupArc>(std::move(start));
}

void Group::index_pairs() {
  const auto each_side = [&](auto&& visit) {
    for (std::uint32_t i = 0; i < pairs.size(); ++i)
      for (const BodyId id : {first_of(pairs[i].id), second_of(pairs[i].id)})
        if (const int member = member_of(id); member >= 0)
          visit(static_cast<std::size_t>(member), i);
  };
  pair_starts.assign(members.size() + 1, 0);
  each_side([&](std::size_t member, std::uint32_t) { ++pair_starts[member + 1]; });
  std::partial_sum(pair_starts.begin(), pair_starts.end(), pair_starts.begin());
  pairs_by_member.resize(pair_starts.back());
  std::vector<std::uint32_t> next = pair_starts;
  each_side([&](std::size_t member, std::uint32_t i) { pairs_by_member[next[member]++] = i; });
}

std::shared_ptr<Group> Kernel::make_group(Regrouping& work, const std::vector<BodyId>& members) {
  auto group = std::make_shared<Group>();
  group->key = work.key;
  group->members = members;
  const double now = work.key.time;

  // its links, and how long those at its border know where they go
  double border_end = never;
  for (const NewContactPair& pair : work.pairs) {
    const bool has_first = group->contains(first_of(pair.id));
    if (!has_first && !group->contains(second_of(pair.id))) continue;
    group->pairs.push_back({pair.id, pair.first, pair.count, pair.has_borne_load});
    const Successor* other = work.successor_of(has_first ? second_of(pair.id) : first_of(pair.id));
    if (!other || !other->body->dynamic() || group->contains(other->body->id())) continue;
    group->has_border = true;
    if (!work.changes(other)) border_end = std::min(border_end, other->data.group->next_check);
  }
  group->index_pairs();
  for (const BodyId id : members) {
    group->lightest = std::min(group->lightest, bodies[id]->mass);
    group->heaviest = std::max(group->heaviest, bodies[id]->mass);
  }
  if (group->has_border) {
    group->lightest = work.lightest;
    group->heaviest = work.heaviest;
  }

  // checks stay on the grid they are on, so that those of neighbours meet
  const auto same = std::find_if(work.old.begin(), work.old.end(),
                                 [&](const auto& old) { return old->members == members; });
  const Group* before = same != work.old.end() ? same->get() : nullptr;
  group->birth = before ? before->birth : now;
  if (!before && group->has_border)
    for (const auto& old : work.old)
      if (!old->at_rest) group->birth = std::min(group->birth, old->birth);

  // the check that is due stays due, unless this is it
  group->next_check =
      std::min(border_end, next_check_time(group->birth, now, check_interval(work, members)));
  const bool is_check = work.key.kind == KeyKind::group_check;
  if (before && !is_check && before->next_check >= now)
    group->next_check = std::min(group->next_check, before->next_check);
  if (before && is_check) {
    group->first_step = before->arc->next_step();
    if (comes_to_rest(work, *group, *before)) {
      group->at_rest = true;
      group->asleep = work.falls_asleep;
      group->next_check = never;
      for (const BodyId id : members) stop(*work.successor_of(id));
    }
  }
  for (const BodyId id : members) {
    const auto place = static_cast<std::size_t>(work.successor_of(id) - work.successors.data());
    group->stillness.push_back(work.stillness[place]);
    group->asleep = group->asleep || work.asleep[place];
  }
  if (group->asleep) {
    group->at_rest = true;
    group->next_check = never;
    for (const BodyId id : members) stop(*work.successor_of(id));
  }
  start_arc_of(*group, work);
  return group;
}

// How many pieces the drafts and their links make; what lies beyond the border is one.
std::size_t Kernel::count_pieces(const Regrouping& work,
                                 const std::vector<std::uint64_t>& in_contact) const {
  const std::size_t rest = work.successors.size();
  Components components(rest + 1);
  const auto place = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    return work.changes(successor) ? static_cast<std::size_t>(successor - work.successors.data())
                                   : rest;
  };
  std::size_t joints = 0;
  for (const std::uint64_t pair : in_contact) {
    const BodyId a = first_of(pair), b = second_of(pair);
    if (!bodies[a]->dynamic() || !bodies[b]->dynamic()) continue;
    const std::size_t i = place(a), j = place(b);
    if (components.root(i) == components.root(j)) continue;
    components.join(i, j);
    ++joints;
  }
  return rest + 1 - joints;
}

// Bodies that came apart, and those that left the ground alone.
void Kernel::count_fissions(Regrouping& work, const std::vector<bool>& held) const {
  std::vector<std::uint64_t> before, after;
  for (const PairBefore& pair : work.before) before.push_back(pair.id);
  for (const NewContactPair& pair : work.pairs) after.push_back(pair.id);
  const std::size_t pieces_before = count_pieces(work, before), pieces = count_pieces(work, after);
  std::size_t parted = pieces > pieces_before ? pieces - pieces_before : 0;
  for (std::size_t i = 0; i < work.successors.size(); ++i) {
    const Successor& successor = work.successors[i];
    if (work.changes(&successor) && !held[i] && successor.data.group &&
        successor.data.group->members.size() == 1)
      ++parted;
  }
  work.tally.fissions = static_cast<std::uint16_t>(parted);
}

void Kernel::finish(Regrouping& work) {
  work.update_index();
  std::sort(work.pairs.begin(), work.pairs.end(),
            [](const NewContactPair& x, const NewContactPair& y) { return x.id < y.id; });
  share_stiffness(work);

  // who lies still
  const std::size_t count = work.successors.size();
  work.stillness.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    if (work.changes(&work.successors[i]))
      work.stillness[i] = stillness_of(work.successors[i], work.key);
  work.asleep = work.may_sleep ? sleepers(work) : std::vector<bool>(count, false);

  // who hangs together, and who has a link at all
  Components components(count);
  std::vector<bool> held(count, false);
  for (const NewContactPair& pair : work.pairs) {
    const Successor* a = work.successor_of(first_of(pair.id));
    const Successor* b = work.successor_of(second_of(pair.id));
    const auto place = [&](const Successor* d) {
      return static_cast<std::size_t>(d - work.successors.data());
    };
    const bool moves_a = work.changes(a), moves_b = work.changes(b);
    if (moves_a) held[place(a)] = true;
    if (moves_b) held[place(b)] = true;
    if (moves_a && moves_b && work.asleep[place(a)] == work.asleep[place(b)])
      components.join(place(a), place(b));
  }
  count_fissions(work, held);

  // one group a component, by ascending members
  std::vector<std::vector<BodyId>> groups(count);
  for (const auto& [id, i] : work.index)
    if (held[i]) groups[components.root(i)].push_back(id);
  std::vector<std::shared_ptr<Group>> made(count);
  for (std::size_t root = 0; root < count; ++root)
    if (!groups[root].empty()) work.made.push_back(made[root] = make_group(work, groups[root]));

  note_changes(work);
  add_report(work);
  for (std::size_t i = 0; i < count; ++i) {
    Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    const std::size_t root = components.root(i);
    successor.data.group = made[root];
    successor.data.member = 0;
    if (!held[i]) continue;
    const auto& members = groups[root];
    const auto at = std::lower_bound(members.begin(), members.end(), successor.body->id());
    successor.data.member = static_cast<std::uint32_t>(at - members.begin());
    successor.data.follows =
        made[root]->at_rest
            ? make_resting({successor.data.x, successor.data.q})
            : member_trajectory(made[root]->arc, static_cast<int>(successor.data.member));
  }
}

// On the first state that enters the graph.
void Kernel::add_report(Regrouping& work) const {
  for (Successor& successor : work.successors) {
    if (!successor.enters()) continue;
    successor.data.tally.add(work.tally);
    if (work.report.empty()) return;
    Report all = successor.data.report ? *successor.data.report : Report();
    all.insert(all.end(), work.report.begin(), work.report.end());
    successor.data.report = std::make_shared<const Report>(std::move(all));
    return;
  }
}

void Kernel::count_group(const Group& group) {
  ++counters.groups;
  counters.largest_group_bodies =
      std::max<std::uint64_t>(counters.largest_group_bodies, group.members.size());
  counters.largest_group_contacts =
      std::max<std::uint64_t>(counters.largest_group_contacts, group.tags.size());
}

}  // namespace tw
