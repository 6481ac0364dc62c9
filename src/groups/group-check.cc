// Group checks: contacts refreshed, fissions found, rest recognised, the next check chosen.
//
// Checks lie at birth + k 2^j / rate, j such that no surface point moves more than a twentieth of
// its body's size in between (doc/numerics.md: finer is cheaper while bodies collide, coarser while
// they do not).  What a check finds depends on the group's arcs alone.
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
// ... and rests when it was so for this long, s, no loaded contact slips, and its speed has fallen
// to half or is below this share: what tips over slowly gets faster, what settles gets slower.
constexpr double rest_time = 0.2;
constexpr double still_share = 1e-7;

void report_fission(Regrouping& work, const Group& group, const ContactPair& pair) {
  Collision row;
  row.kind = CollisionKind::fission;
  row.key = work.key;
  row.time = work.key.time;
  row.body1 = first_of(pair.id);
  row.body2 = second_of(pair.id);
  if (pair.count > 0) {
    const double now = group.contact_time(work.key.time);
    const ContactForce f = group.arc->contact_force(static_cast<int>(pair.first), now);
    const bool straight = group.tags[pair.first].reference == row.body1;
    row.point = f.point;
    row.normal = straight ? f.normal : Vec3(-f.normal);
  }
  work.report.push_back(row);
}

}  // namespace

// Just before what happens to a group at `when`.
Key Kernel::group_check_key(const Group& group, double when) const {
  const bool starts_now = group.key.time == when;
  return {when, 1 + (starts_now ? group.key.microstep : 0), KeyKind::group_check, 0};
}

// Every member of a moving group waits for the end of its arc; who comes first acts for all.
void Kernel::schedule_group_check(Body& body) {
  const State* tail = graph.tail(body.process);
  const double end = tail && !tail->error ? tail->trajectory().end() : never;
  if (end == never) {
    queue.withdraw(process(body).group_check);
    return;
  }
  Key key = group_check_key(*tail->group, end);
  key.id = body.id();
  queue.schedule(process(body).group_check,
                 make_event(key, EventKind::group_check, body.id(), process(body).head_start));
}

void Kernel::schedule_group_checks(const Group& group) {
  for (const BodyId id : group.members)
    if (graph.tail(process_of(id))->group.get() == &group) schedule_group_check(*bodies[id]);
}

double Kernel::check_interval(const Regrouping& work, const std::vector<BodyId>& members) const {
  double interval = never;
  for (const BodyId id : members) {
    const PlacedBody side = placed(*work.successor_of(id));
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
bool Kernel::comes_to_rest(Regrouping& work, Group& after, const Group& before) const {
  double speed = 0, scale = never;
  for (const BodyId id : after.members) {
    const PlacedBody side = placed(*work.successor_of(id));
    const double unit = std::sqrt(gravity_magnitude() * side.body->least_width);
    speed = std::max(speed, side.fastest_point());
    scale = std::min(scale, unit);
  }
  const double now = work.key.time;
  bool quiet = speed < quiet_share * scale;
  for (std::size_t c = 0; quiet && c < before.tags.size(); ++c) {
    const ContactForce f = before.arc->contact_force(static_cast<int>(c), now);
    const bool smooth = before.arc->start().contacts[c].law.law == FrictionLaw::smooth;
    if (f.normal_force > 0 && f.slipping && !smooth) quiet = false;
  }
  for (const BodyId other : before.outside) {
    const Successor* border = bodies[other]->dynamic() ? work.successor_of(other) : nullptr;
    const bool still =
        bodies[other]->fixed() ||
        (border && !work.changes(border) && border->data.group && border->data.group->at_rest);
    if (!still) quiet = false;
  }
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

// Which links went, which came: counted, and told as fissions where bodies parted; and how deep
// they are.
void Kernel::note_changes(Regrouping& work) const {
  for (const NewContactPair& pair : work.pairs)
    for (std::uint32_t c = pair.first; c < pair.first + pair.count; ++c)
      work.tally.note_gap(work.contacts[c].gap);
  bool changed = false;
  std::size_t lasting = 0;
  for (const PairBefore& old : work.before) {
    const auto at =
        std::lower_bound(work.pairs.begin(), work.pairs.end(), old.id,
                         [](const NewContactPair& l, std::uint64_t pair) { return l.id < pair; });
    const bool stands = at != work.pairs.end() && at->id == old.id;
    if (stands) {
      ++lasting;
      changed = changed || at->count != old.pair->count;
    } else if (old.pair->has_borne_load && work.tally.fissions > 0 &&
               observed(CollisionKind::fission)) {
      report_fission(work, *old.group, *old.pair);
    }
    changed = changed || !stands;
  }
  changed = changed || lasting != work.pairs.size();
  work.tally.contact_changes = changed;
}

// All that hangs together with the group and is checked at the same time: the parts of a group that
// blows have divided.
std::vector<BodyId> Kernel::family(const std::shared_ptr<Group>& group, const Key& key) const {
  Groups groups{group};
  std::vector<BodyId> all;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const std::vector<BodyId> there = remaining(*groups[i], key);
    all.insert(all.end(), there.begin(), there.end());
    for (const ContactPair& pair : groups[i]->pairs) {
      const BodyId a = first_of(pair.id), b = second_of(pair.id);
      if (!bodies[a]->dynamic() || !bodies[b]->dynamic()) continue;
      // seen from either side, or two checks of one time would take each other back: so links of
      // those that have left do not count
      const State& state_a = *graph.last_before(process_of(a), key);
      const State& state_b = *graph.last_before(process_of(b), key);
      if (state_a.group != groups[i] && state_b.group != groups[i]) continue;
      const Group* owner = owner_of(state_a, state_b);
      if (!owner || !owner->find(pair.id)) continue;
      for (const State* state : {&state_a, &state_b}) {
        if (!state->group || state->error || state->group->next_check != group->next_check)
          continue;
        if (group_check_key(*state->group, key.time).microstep != key.microstep) continue;
        add_once(groups, state->group);
      }
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

// Those whose contacts end at `when`, before the check of their group.
std::vector<BodyId> Kernel::early_bodies(const Group& group, double when, const Key& key) const {
  std::vector<BodyId> all;
  for (std::uint32_t i = 0; i < group.members.size(); ++i) {
    if (group.end(i) != when) continue;
    const State& state = *graph.last_before(process_of(group.members[i]), key);
    if (state.group.get() == &group && !state.error) all.push_back(group.members[i]);
  }
  return all;
}

void Kernel::process_group_check(BodyId id) {
  const State& tail = *graph.tail(process_of(id));
  TW_ASSERT(tail.group && !tail.group->at_rest, "group check of nobody");
  const std::shared_ptr<Group> group = tail.group;
  if (!group->end_tested) {
    test_group_end(*group);
    schedule_group_checks(*group);
    return;
  }
  const double when = tail.trajectory().end();
  Key key = group_check_key(*group, when);
  ++counters.group_checks;

  // only after the claims of kinematic bodies, and those of all that take part, have reached its
  // time
  bool claimed = false;
  for (const BodyId mover : kinematic)
    for (; process(*bodies[mover]).claim.time < key.time; claimed = true)
      claim_window(*bodies[mover]);
  if (claimed) return;
  const bool early = when < group->next_check;
  const auto all_concerned = [&] {
    return early ? early_bodies(*group, when, key) : family(group, key);
  };
  std::vector<BodyId> concerned = all_concerned();
  bool all_known = true;
  for (const BodyId member : concerned) all_known = await(member, key) && all_known;
  if (!all_known) return;

  // the least of them gives the key; some may have left by lesser keys of this instant
  while (key.id != concerned.front()) {
    key.id = concerned.front();
    concerned = all_concerned();
  }
  std::vector<Successor> successors;
  successors.reserve(concerned.size());
  const Group* failed = nullptr;
  for (const BodyId member : concerned) {
    const Group& theirs = *graph.last_before(process_of(member), key)->group;
    theirs.arc->extend(key.time);
    if (!theirs.arc->failure().empty()) failed = &theirs;
    successors.push_back(make_successor(*bodies[member], key, true));
  }
  if (failed) {
    const UserError error(group_failure(*failed), bodies[key.id]->info.place);
    for (Successor& successor : successors) successor.data.error = std::make_exception_ptr(error);
  } else if (!regroup(key, successors, early ? Cause::early_check : Cause::check)) {
    return;
  }
  enter_discontinuity(key, successors);
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

}  // namespace tw
