// Group checks: contacts refreshed, fissions found, rest recognised, the next check chosen.
//
// Checks lie at birth + k 2^j / rate, j such that no surface point moves more than a twentieth of its
// body's size in between (doc/numerics.md: finer is cheaper while bodies collide, coarser while they do
// not).  What a check finds depends on the group's arcs alone.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {
namespace {

// A surface point moves at most this share of its body's size between checks.
constexpr double most_travel = 0.05;
// The slowest checks are 2^most_halvings times rarer than the finest.
constexpr int most_halvings = 5;

// A group is quiet while no surface point is faster than this share of sqrt(g size) ...
constexpr double quiet_share = 5e-3;
// ... and rests when it was so for this long, s, no loaded contact slips, and its speed has fallen to half
// or is below this share: what tips over slowly gets faster, what settles gets slower.
constexpr double rest_time = 0.2;
constexpr double still_share = 1e-7;

void tell_fission(Regroup& work, const Group& group, const GroupLink& link) {
  Collision row;
  row.kind = CollisionKind::fission;
  row.key = work.key;
  row.time = work.key.time;
  row.body1 = static_cast<BodyId>(link.pair >> 32);
  row.body2 = static_cast<BodyId>(link.pair & 0xffffffffu);
  if (link.count > 0) {
    const double now = group.at_rest ? group.arc->start().time : work.key.time;
    const ContactForce f = group.arc->contact_force(static_cast<int>(link.first), now);
    const bool straight = group.tags[link.first].reference == row.body1;
    row.point = f.point;
    row.normal = straight ? f.normal : Vec3(-f.normal);
  }
  work.told.push_back(row);
}

}  // namespace

Key Kernel::group_check_key(const Group& group) const {
  const bool starts_now = group.key.time == group.next_check;
  return {group.next_check, 1 + (starts_now ? group.key.microstep : 0), KeyKind::group_check,
          group.leader()};
}

// The event of the group that the body leads, if it does.
void Kernel::schedule_group_check(Body& body) {
  const State* tail = graph.tail(body.id());
  const Group* group = tail && !tail->error ? tail->group.get() : nullptr;
  if (!group || group->leader() != body.id() || group->next_check == never) {
    queue.withdraw(body.group_check);
    return;
  }
  queue.schedule(body.group_check, make_event(group_check_key(*group), EventKind::group_check,
                                              body.id(), body.head_start));
}

double Kernel::check_interval(const Regroup& work, const std::vector<BodyId>& members) const {
  double interval = never;
  for (const BodyId id : members) {
    const Side side = side_of(*work.draft_of(id));
    const double distance = most_travel * side.body->least_width;
    const double speed = side.surface_speed();
    const double root = std::sqrt(speed * speed + 2 * gravity_magnitude() * distance);
    interval = std::min(interval, 2 * distance / (speed + root));
  }
  // to a power of two on the grid
  const double ticks = interval * options.group_check_rate;
  const int halvings = ticks > 1 ? std::min(most_halvings, std::ilogb(ticks)) : 0;
  return std::ldexp(1 / options.group_check_rate, halvings);
}

double Kernel::next_check_time(double birth, double now, double interval) const {
  double k = std::max(0.0, std::floor((now - birth) / interval));
  while (birth + k * interval <= now) ++k;
  return birth + k * interval;
}

// Whether the group, unchanged in its members, has come to rest; keeps the books of its quiet time.
bool Kernel::comes_to_rest(Regroup& work, Group& after, const Group& before) const {
  double speed = 0, scale = never;
  for (const BodyId id : after.members) {
    const Side side = side_of(*work.draft_of(id));
    const double unit = std::sqrt(gravity_magnitude() * side.body->least_width);
    speed = std::max(speed, side.surface_speed() + side.point.w.norm() * side.body->radius);
    scale = std::min(scale, unit);
  }
  const double now = work.key.time;
  bool quiet = speed < quiet_share * scale;
  for (std::size_t c = 0; quiet && c < before.tags.size(); ++c) {
    const ContactForce f = before.arc->contact_force(static_cast<int>(c), now);
    const bool smooth = before.arc->start().contacts[c].law.law == FrictionLaw::smooth;
    if (f.normal_force > 0 && f.slipping && !smooth) quiet = false;
  }
  for (const BodyId other : before.outside)
    if (!bodies[other]->fixed()) quiet = false;
  if (!quiet) return false;

  // gets faster: not at rest, but perhaps from here on
  if (before.quiet_since == never || speed > before.quiet_speed) {
    after.quiet_since = now;
    after.quiet_speed = speed;
    return false;
  }
  after.quiet_since = before.quiet_since;
  after.quiet_speed = before.quiet_speed;
  return now - before.quiet_since >= rest_time &&
         (speed <= 0.5 * before.quiet_speed || speed <= still_share * scale);
}

// Which links went, which came: counted, and told as fissions where bodies parted.
void Kernel::note_changes(Regroup& work) const {
  bool changed = false;
  std::size_t lasting = 0;
  for (const auto& group : work.old)
    for (const GroupLink& link : group->links) {
      const auto at = std::lower_bound(
          work.links.begin(), work.links.end(), link.pair,
          [](const LooseLink& l, std::uint64_t pair) { return l.pair < pair; });
      const bool stands = at != work.links.end() && at->pair == link.pair;
      if (stands) {
        ++lasting;
        changed = changed || at->count != link.count;
      } else if (link.touched && work.tally.fissions > 0 && observed(CollisionKind::fission)) {
        tell_fission(work, *group, link);
      }
      changed = changed || !stands;
    }
  changed = changed || lasting != work.links.size();
  work.tally.contact_changes = changed;
}

void Kernel::process_group_check(BodyId leader) {
  const State& tail = *graph.tail(leader);
  TW_ASSERT(tail.group && tail.group->leader() == leader, "group check of nobody");
  const std::shared_ptr<Group> group = tail.group;
  if (!group->end_tested) {
    test_group_end(*group);
    schedule_group_check(*bodies[leader]);
    return;
  }
  const Key key = group_check_key(*group);
  ++counters.group_checks;

  // only after the members' claims, and those of kinematic bodies, have reached its time
  bool claimed = false;
  for (const BodyId id : kinematic)
    for (; bodies[id]->claim.time < key.time; claimed = true) claim_window(*bodies[id]);
  for (const BodyId id : group->members)
    for (; bodies[id]->claim.time < key.time; claimed = true) claim_window(*bodies[id]);
  // these may have found something that comes first
  if (claimed) return;

  std::vector<Draft> drafts;
  drafts.reserve(group->members.size());
  group->arc->extend(key.time);
  for (const BodyId id : group->members) drafts.push_back(draft_for(*bodies[id], key, true));
  if (!group->arc->failure().empty()) {
    const UserError error(group_failure(*group), bodies[leader]->info.place);
    for (Draft& draft : drafts) draft.data.error = std::make_exception_ptr(error);
  } else {
    Regroup work(key, drafts);
    collect_old(work);
    refresh(work, *group, check_interval(work, group->members));
    pass_on(work);
    finish(work);
  }
  enter_discontinuity(key, drafts);
}

// Whose motion could not be followed, when and where.
std::string Kernel::group_failure(const Group& group) const {
  std::string all;
  constexpr std::size_t most_names = 8;
  for (std::size_t i = 0; i < std::min(most_names, group.members.size()); ++i)
    all += (i ? ", " : "") + bodies[group.members[i]]->info.name;
  if (group.members.size() > most_names)
    all += " and " + std::to_string(group.members.size() - most_names) + " more";
  std::string where;
  if (const int c = group.arc->failed_contact(); c >= 0) {
    const ContactTag& tag = group.tags[static_cast<std::size_t>(c)];
    where = ", at the contact of " + bodies[tag.reference]->info.name + " and " +
            bodies[tag.other]->info.name;
  }
  return "the contact group of " + all + " cannot be followed past " + show(group.arc->reached()) +
         " s: " + group.arc->failure() + where +
         "; expected finite forces (look at #:stiffness, #:damping and the masses)";
}

}  // allpace tw
