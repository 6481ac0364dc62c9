// Sleepers: members of a moving group that stand still provisionally.
//
// One stone that rocks keeps a heap awake, for rest is decided for whole groups.  So at the check
// of a large group those of its members that hardly move are laid to rest for the time being:
// groups at rest of their own, in which the others see still bodies at their border (region.cc),
// and which wake where the forces on them change.  What comes to rest beside sleepers goes to
// sleep, too, as long as something moves that touches any of those that hang together with it; the
// last one wakes them all, and all come to rest together, watched by the rule for whole groups
// (group-check.cc): nothing is frozen in the end that would have moved.
//
// A member is laid to rest when it was slow for a while without getting faster or away (so neither
// a tower that begins to tip nor a ball that creeps), no loaded contact of it slips, and everything
// it touches is slow or still, too.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/stillness.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace tw {
namespace {

// Calm: slower than this share of sqrt(g size).
constexpr double calm_share = 5e-4;
// s; the second half's peak must not exceed the first's by more, and the way made by this share of
// it.
constexpr double watch = 0.5, growth = 1.1, drift = 0.1;
// Fewer are not worth a group of their own: a number, and a share of the group.
constexpr std::size_t least_sleepers = 8;
constexpr double least_share = 0.25;

bool stays(const Stillness& stillness, const PlacedBody& side, double now) {
  const double way = std::max(stillness.early_peak, stillness.peak) * (now - stillness.since);
  const double turned = side.point.q.angularDistance(stillness.q) * side.body->radius;
  return stillness.peak <= growth * stillness.early_peak &&
         (side.point.x - stillness.x).norm() + turned <= drift * way;
}

}  // namespace

// The books of one body at a discontinuity.
Stillness Kernel::stillness_of(const Successor& successor, const Key& key) const {
  const PlacedBody side = placed(successor);
  const double speed = side.fastest_point();
  if (speed >= calm_share * std::sqrt(gravity_magnitude() * side.body->least_width)) return {};
  const Group* group = successor.data.group.get();
  const Stillness known =
      group && !group->at_rest ? group->stillness[successor.data.member] : Stillness();
  const double age = key.time - known.since;
  if (known.since == never || (age > watch && !stays(known, side, key.time)))
    return {key.time, speed, 0, side.point.x, side.point.q};
  Stillness stillness = known;
  (age < 0.5 * watch ? stillness.early_peak : stillness.peak) =
      std::max(age < 0.5 * watch ? stillness.early_peak : stillness.peak, speed);
  return stillness;
}

// Which of the drafts are laid to rest provisionally, at the check of whole groups.
std::vector<bool> Kernel::sleepers(const Regrouping& work) const {
  const std::vector<Stillness>& stillness = work.stillness;
  const std::size_t count = work.successors.size();
  std::vector<bool> asleep(count, false);
  std::size_t moving = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    ++moving;
    const double age = work.key.time - stillness[i].since;
    asleep[i] = age > watch && stays(stillness[i], placed(successor), work.key.time);
  }
  const auto too_few = [&] {
    const auto number = static_cast<std::size_t>(std::count(asleep.begin(), asleep.end(), true));
    return number < least_sleepers ||
           static_cast<double>(number) < least_share * static_cast<double>(moving);
  };
  if (too_few()) return std::vector<bool>(count, false);

  // what touches something that moves, or slips, stays awake
  const auto place = [&](const Successor* d) {
    return static_cast<std::size_t>(d - work.successors.data());
  };
  const auto disturbs = [&](BodyId id) {
    const Successor* successor = work.successor_of(id);
    if (!bodies[id]->dynamic()) return !bodies[id]->fixed();
    if (work.changes(successor)) return stillness[place(successor)].since == never;
    return !successor->data.group || !successor->data.group->at_rest;
  };
  for (const PairBefore& old : work.before) {
    const BodyId a = first_of(old.id), b = second_of(old.id);
    const Successor *da = work.successor_of(a), *db = work.successor_of(b);
    const bool lies_a = work.changes(da) && asleep[place(da)],
               lies_b = work.changes(db) && asleep[place(db)];
    if (!lies_a && !lies_b) continue;
    bool slips = false;
    const double when = old.group->contact_time(work.key.time);
    for (std::uint32_t c = old.pair->first; c < old.pair->first + old.pair->count && !slips; ++c) {
      const ContactForce f = old.group->arc->contact_force(static_cast<int>(c), when);
      slips = f.normal_force > 0 && f.slipping;
    }
    if (lies_a && (slips || (old.pair->count > 0 && disturbs(b)))) asleep[place(da)] = false;
    if (lies_b && (slips || (old.pair->count > 0 && disturbs(a)))) asleep[place(db)] = false;
  }
  if (too_few()) return std::vector<bool>(count, false);
  return asleep;
}

// All that lie provisionally at rest around groups that would come to rest now: they wake instead.
std::vector<BodyId> Kernel::asleep_around(const Regrouping& work) const {
  std::vector<BodyId> around;
  for (const auto& group : work.made)
    if (group->at_rest && !group->asleep)
      for (const BodyId id : group->outside) {
        const Successor* successor = bodies[id]->dynamic() ? work.successor_of(id) : nullptr;
        if (successor && !work.changes(successor) && successor->data.group->asleep)
          around.push_back(id);
      }
  return around;
}

}  // namespace tw
