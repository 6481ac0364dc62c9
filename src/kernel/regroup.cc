// Making groups: gathering the members of old ones, carrying their contacts along, and cutting what is
// linked into new ones.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "kernel/regroup.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/kernel.h"
#include "kernel/tolerances.h"

namespace tw {
namespace {

// Contacts of one body with several fixed ones share one stiffness where their normals agree to this, rad.
constexpr double coplanar = 1e-3;

BodyId first_of(std::uint64_t pair) { return static_cast<BodyId>(pair >> 32); }
BodyId second_of(std::uint64_t pair) { return static_cast<BodyId>(pair & 0xffffffffu); }

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
void stop(Draft& draft) {
  draft.point.v = draft.point.w = draft.data.v = draft.data.L = Vec3::Zero();
}

bool changes_arc(const Draft& draft, const Key& key) {
  return draft.body->dynamic() && draft.data.arc_key == key;
}

}  // namespace

Draft* Regroup::draft_of(BodyId id) const {
  const auto at = std::lower_bound(index.begin(), index.end(), std::pair{id, std::size_t{0}});
  return at != index.end() && at->first == id ? &drafts[at->second] : nullptr;
}

void Regroup::update_index() {
  index.clear();
  for (std::size_t i = 0; i < drafts.size(); ++i) index.push_back({drafts[i].body->id(), i});
  std::sort(index.begin(), index.end());
}

void Kernel::gather(const Key& key, std::vector<Draft>& drafts) const {
  std::vector<BodyId> wanted;
  for (const Draft& draft : drafts)
    if (changes_arc(draft, key) && draft.data.group)
      wanted.insert(wanted.end(), draft.data.group->members.begin(),
                    draft.data.group->members.end());
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());

  // those that are there but were only read start a new arc too
  for (Draft& draft : drafts) {
    const auto at = std::lower_bound(wanted.begin(), wanted.end(), draft.body->id());
    if (at == wanted.end() || *at != draft.body->id()) continue;
    if (draft.data.arc_key != key) start_new_arc(draft, key);
    wanted.erase(at);
  }
  drafts.reserve(drafts.size() + wanted.size());
  for (const BodyId id : wanted) drafts.push_back(draft_for(*bodies[id], key, true));
}

void Kernel::collect_old(Regroup& work) const {
  work.update_index();
  for (const auto& [id, i] : work.index) {
    const Draft& draft = work.drafts[i];
    const std::shared_ptr<Group>& group = draft.data.group;
    if (!changes_arc(draft, work.key) || !group) continue;
    if (group->leader() == id) work.old.push_back(group);
  }
  for (const Draft& draft : work.drafts) {
    if (!draft.body->dynamic()) continue;
    work.lightest = std::min(work.lightest, draft.body->mass);
    work.heaviest = std::max(work.heaviest, draft.body->mass);
  }
}

// Links and contacts as they stand, stretches evaluated at the key's time.
void Kernel::carry(Regroup& work, const Group& group) const {
  GroupArc& arc = *group.arc;
  const double now = group.at_rest ? arc.start().time : work.key.time;
  for (const GroupLink& link : group.links) {
    const Draft* a = work.draft_of(first_of(link.pair));
    const Draft* b = work.draft_of(second_of(link.pair));
    if ((a && a->placed) || (b && b->placed)) continue;
    const Body& body_a = *bodies[first_of(link.pair)];
    const Body& body_b = *bodies[second_of(link.pair)];
    // between runs somebody may have set them anew
    const bool renew = work.key.kind == KeyKind::edit;
    if (renew && !may_collide(body_a, body_b)) continue;
    work.links.push_back({link.pair, static_cast<std::uint32_t>(work.contacts.size()), link.count,
                          link.touched});
    for (std::uint32_t c = link.first; c < link.first + link.count; ++c) {
      const int number = static_cast<int>(c);
      const ContactForce f = arc.contact_force(number, now);
      LooseContact loose{arc.start().contacts[c], group.tags[c], f.gap, f.normal, f.point};
      loose.contact.stretch = arc.stretch(number, now);
      work.contacts.push_back(loose);
    }
  }
}

// Each point's share of its pair's stiffness: 1 / (points that touch or nearly do), those on coplanar
// neighbours of the ground taken together.
void Kernel::share_out(Regroup& work) const {
  const auto near = [](const LooseContact& c) { return c.gap <= c.contact.law.depth; };
  std::vector<std::pair<BodyId, std::uint32_t>> on_ground;
  for (const LooseLink& link : work.links) {
    const bool both = bodies[first_of(link.pair)]->dynamic() && bodies[second_of(link.pair)]->dynamic();
    const BodyId mover = bodies[first_of(link.pair)]->dynamic() ? first_of(link.pair) : second_of(link.pair);
    int count = 0;
    for (std::uint32_t c = link.first; c < link.first + link.count; ++c) {
      if (!both) on_ground.push_back({mover, c});
      count += near(work.contacts[c]);
    }
    for (std::uint32_t c = link.first; both && c < link.first + link.count; ++c)
      work.contacts[c].contact.share = 1.0 / std::max(1, count);
  }

  std::sort(on_ground.begin(), on_ground.end());
  for (std::size_t i = 0, j = 0; i < on_ground.size(); i = j) {
    for (j = i; j < on_ground.size() && on_ground[j].first == on_ground[i].first;) ++j;
    for (std::size_t k = i; k < j; ++k) {
      LooseContact& mine = work.contacts[on_ground[k].second];
      int count = 0;
      for (std::size_t l = i; l < j; ++l) {
        const LooseContact& other = work.contacts[on_ground[l].second];
        // seen from the ground both normals point the same way
        const double sign = (mine.tag.reference == on_ground[i].first) ==
                                    (other.tag.reference == on_ground[i].first) ? 1 : -1;
        count += near(other) && sign * mine.normal.dot(other.normal) > 1 - 0.5 * coplanar * coplanar;
      }
      mine.contact.share = 1.0 / std::max(1, count);
    }
  }
}

// Bodies, outside bodies and contacts as the integrator wants them.
void Kernel::start_arc_of(Group& group, Regroup& work) const {
  GroupStart start;
  start.time = work.key.time;
  start.end = group.next_check;
  double size = never, lightest = never, heaviest = 0;
  for (const BodyId id : group.members) {
    const Draft& draft = *work.draft_of(id);
    const Body& body = *draft.body;
    const StateData& d = draft.data;
    start.members.push_back({body.mass, body.moments, body.radius, d.x, d.q, d.v, d.L,
                             body.mass * d.acceleration, Vec3::Zero()});
    size = std::min(size, body.least_width);
    lightest = std::min(lightest, body.mass);
    heaviest = std::max(heaviest, body.mass);
  }
  start.position_tolerance = group_position_tolerance(options.accuracy, size);
  start.velocity_tolerance = group_velocity_tolerance(options.accuracy, size, gravity_magnitude());

  const auto index_of = [&](BodyId id) {
    const auto member = std::lower_bound(group.members.begin(), group.members.end(), id);
    if (member != group.members.end() && *member == id)
      return static_cast<int>(member - group.members.begin());
    const auto known = std::find(group.outside.begin(), group.outside.end(), id);
    if (known != group.outside.end()) return ~static_cast<int>(known - group.outside.begin());
    group.outside.push_back(id);
    start.outside.push_back(bodies[id]->motion);
    return ~static_cast<int>(group.outside.size() - 1);
  };
  for (GroupLink& link : group.links) {
    const std::uint32_t first = static_cast<std::uint32_t>(start.contacts.size());
    const ContactConstants law = contact_law(*bodies[first_of(link.pair)], *bodies[second_of(link.pair)],
                                              lightest, heaviest);
    for (std::uint32_t c = link.first; c < link.first + link.count; ++c) {
      LooseContact& loose = work.contacts[c];
      loose.contact.law = law;
      loose.contact.a = index_of(loose.tag.reference);
      loose.contact.b = index_of(loose.tag.other);
      start.contacts.push_back(loose.contact);
      group.tags.push_back(loose.tag);
      group.gaps.push_back(loose.gap);
      link.touched = link.touched || loose.gap < 0;
    }
    link.first = first;
  }
  start.first_step = group.first_step;
  group.arc = std::make_unique<GroupArc>(std::move(start));
}

std::shared_ptr<Group> Kernel::make_group(Regroup& work, const std::vector<BodyId>& members) {
  auto group = std::make_shared<Group>();
  group->key = work.key;
  group->members = members;
  const auto same = std::find_if(work.old.begin(), work.old.end(),
                                 [&](const auto& old) { return old->members == members; });
  const Group* before = same != work.old.end() ? same->get() : nullptr;
  const double now = work.key.time;
  group->birth = before ? before->birth : now;
  for (const LooseLink& link : work.links) {
    const BodyId id = bodies[first_of(link.pair)]->dynamic() ? first_of(link.pair) : second_of(link.pair);
    if (std::binary_search(members.begin(), members.end(), id))
      group->links.push_back({link.pair, link.first, link.count, link.touched});
  }

  // the check that is due stays due, unless this is it
  group->next_check = next_check_time(group->birth, now, check_interval(work, members));
  const bool is_check = work.key.kind == KeyKind::group_check;
  if (before && !is_check && before->next_check >= now)
    group->next_check = std::min(group->next_check, before->next_check);
  if (before && is_check) {
    group->first_step = before->arc->next_step();
    if (comes_to_rest(work, *group, *before)) {
      group->at_rest = true;
      group->next_check = never;
      for (const BodyId id : members) stop(*work.draft_of(id));
    }
  }
  start_arc_of(*group, work);
  ++counters.groups;
  counters.largest_group_bodies = std::max<std::uint64_t>(counters.largest_group_bodies, members.size());
  counters.largest_group_contacts =
      std::max<std::uint64_t>(counters.largest_group_contacts, group->tags.size());
  return group;
}

void Kernel::finish(Regroup& work) {
  work.update_index();
  std::sort(work.links.begin(), work.links.end(),
            [](const LooseLink& x, const LooseLink& y) { return x.pair < y.pair; });
  share_out(work);

  // who hangs together, and who has a link at all
  const std::size_t count = work.drafts.size();
  Components components(count);
  std::vector<bool> held(count, false);
  for (const LooseLink& link : work.links) {
    const Draft* a = work.draft_of(first_of(link.pair));
    const Draft* b = work.draft_of(second_of(link.pair));
    const auto place = [&](const Draft* d) { return static_cast<std::size_t>(d - work.drafts.data()); };
    const bool moves_a = a && a->body->dynamic(), moves_b = b && b->body->dynamic();
    if (moves_a) held[place(a)] = true;
    if (moves_b) held[place(b)] = true;
    if (moves_a && moves_b) components.join(place(a), place(b));
  }

  // one group a component, by ascending members
  std::vector<std::vector<BodyId>> groups(count);
  std::size_t before = work.old.size(), after = 0, freed = 0, lone = 0;
  for (const auto& [id, i] : work.index) {
    Draft& draft = work.drafts[i];
    if (!changes_arc(draft, work.key)) continue;
    if (held[i]) {
      groups[components.root(i)].push_back(id);
      continue;
    }
    freed += draft.data.group != nullptr;
    lone += draft.data.group && draft.data.group->members.size() == 1;
    draft.data.group.reset();
    draft.data.member = 0;
  }
  for (const auto& members : groups) {
    if (members.empty()) continue;
    ++after;
    const std::shared_ptr<Group> group = make_group(work, members);
    for (std::size_t m = 0; m < members.size(); ++m) {
      Draft& draft = *work.draft_of(members[m]);
      draft.data.group = group;
      draft.data.member = static_cast<std::uint32_t>(m);
    }
  }
  // a lone body that leaves the ground is a fission too
  if (after + freed + lone > before && before > 0)
    work.tally.fissions = static_cast<std::uint16_t>(after + freed + lone - before);
  note_changes(work);
  tell(work);
}

// On the first state that enters the graph.
void Kernel::tell(Regroup& work) const {
  for (Draft& draft : work.drafts) {
    if (!draft.enters) continue;
    draft.data.tally = work.tally;
    if (work.told.empty()) return;
    Told all = draft.data.told ? *draft.data.told : Told();
    all.insert(all.end(), work.told.begin(), work.told.end());
    draft.data.told = std::make_shared<const Told>(std::move(all));
    return;
  }
}

void Kernel::regroup_changed(const Key& key, std::vector<Draft>& drafts) {
  const bool any = std::any_of(drafts.begin(), drafts.end(), [&](const Draft& d) {
    return changes_arc(d, key) && d.data.group;
  });
  if (!any) return;
  gather(key, drafts);
  Regroup work(key, drafts);
  collect_old(work);
  for (const auto& group : work.old) carry(work, *group);
  finish(work);
}

}  // namespace tw
