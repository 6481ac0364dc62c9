// Rest and sleep.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/rest.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace tw {
namespace {

// The scale of speeds of a body: what it falls through its own size at, m/s.
double speed_scale(const Scene& scene, const Body& body) {
  return std::sqrt(scene.gravity_scale() * body.least_width);
}

// Neither faster nor away since the book began.
bool stays(const Stillness& book, const PlacedBody& body, double now) {
  const double way = std::max(book.early_peak, book.peak) * (now - book.since);
  const double turned = body.point.q.angularDistance(book.q) * body.body->radius;
  return book.peak <= answer::growth * book.early_peak &&
         (body.point.x - book.x).norm() + turned <= answer::drift * way;
}

// The book of one body at the discontinuity.
Stillness stillness_of(const Regrouping& work, const Successor& successor) {
  const PlacedBody body = placed(successor);
  const double speed = body.fastest_point(), now = work.now();
  if (speed >= answer::sleep_share * speed_scale(work.scene(), *body.body)) return {};
  const Group* group = successor.data.group.get();
  const Stillness known =
      group && !group->at_rest ? group->stillness[successor.data.member] : Stillness();
  const double age = now - known.since;
  if (known.since == never || (age > answer::sleep_time && !stays(known, body, now)))
    return {now, speed, 0, body.point.x, body.point.q};
  Stillness book = known;
  double& peak = age < 0.5 * answer::sleep_time ? book.early_peak : book.peak;
  peak = std::max(peak, speed);
  return book;
}

// Whether what is in contact with it keeps a body awake.
bool keeps_awake(const Regrouping& work, BodyId id) {
  const Body& body = work.scene().body(id);
  if (!body.dynamic()) return !body.fixed();
  const Successor* successor = work.successor_of(id);
  if (work.changes(successor)) return work.stillness[work.place_of(successor)].since == never;
  return !successor->data.group || !successor->data.group->at_rest;
}

bool slips(const PairBefore& old, double when) {
  bool found = false;
  each_contact(*old.pair, [&](std::uint32_t c) {
    if (found) return;
    const ContactForce f = old.owner->contact_at(c, when);
    found = f.normal_force > 0 && f.slipping;
  });
  return found;
}

// Which of the successors fall asleep, at the check of whole groups.
std::vector<bool> sleepers(const Regrouping& work) {
  const std::size_t count = work.successors.size();
  std::vector<bool> asleep(count, false);
  std::size_t moving = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Successor& successor = work.successors[i];
    if (!work.changes(&successor)) continue;
    ++moving;
    const Stillness& book = work.stillness[i];
    asleep[i] =
        work.now() - book.since > answer::sleep_time && stays(book, placed(successor), work.now());
  }
  const auto too_few = [&] {
    const auto number = static_cast<std::size_t>(std::count(asleep.begin(), asleep.end(), true));
    return number < answer::least_sleepers ||
           static_cast<double>(number) < answer::least_sleeping_share * static_cast<double>(moving);
  };
  if (too_few()) return std::vector<bool>(count, false);

  // what touches something that moves, or slips, stays awake
  for (const PairBefore& old : work.pairs_before) {
    const BodyId a = old.pair->a(), b = old.pair->b();
    const Successor *sa = work.successor_of(a), *sb = work.successor_of(b);
    const bool lies_a = work.changes(sa) && asleep[work.place_of(sa)];
    const bool lies_b = work.changes(sb) && asleep[work.place_of(sb)];
    if (!lies_a && !lies_b) continue;
    const bool slipping = slips(old, work.now()), touches = old.pair->count > 0;
    if (lies_a && (slipping || (touches && keeps_awake(work, b))))
      asleep[work.place_of(sa)] = false;
    if (lies_b && (slipping || (touches && keeps_awake(work, a))))
      asleep[work.place_of(sb)] = false;
  }
  if (too_few()) return std::vector<bool>(count, false);
  return asleep;
}

// Slow, nothing loaded slips, and everything outside stands still.
bool is_quiet(const Regrouping& work, const Group& before, double speed, double scale) {
  if (!(speed < answer::quiet_share * scale)) return false;
  for (std::size_t c = 0; c < before.tags.size(); ++c) {
    const ContactForce f = before.arc->contact_force(static_cast<int>(c), work.now());
    const bool smooth = before.arc->start().contacts[c].law.law == FrictionLaw::smooth;
    if (f.normal_force > 0 && f.slipping && !smooth) return false;
  }
  return std::all_of(before.outside.begin(), before.outside.end(), [&](BodyId id) {
    const Body& body = work.scene().body(id);
    if (!body.dynamic()) return body.fixed();
    const Successor* border = work.successor_of(id);
    return border && !work.changes(border) && border->data.group && border->data.group->at_rest;
  });
}

}  // namespace

void note_stillness(Regrouping& work) {
  const std::size_t count = work.successors.size();
  work.stillness.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    if (work.changes(&work.successors[i]))
      work.stillness[i] = stillness_of(work, work.successors[i]);
  const bool may_sleep = work.cause == Cause::check;
  work.asleep = may_sleep ? sleepers(work) : std::vector<bool>(count, false);
}

bool comes_to_rest(const Regrouping& work, Group& group, const Group& before) {
  double speed = 0, scale = never;
  for (const ProcessId member : group.members) {
    const PlacedBody body = placed(*work.successor_of(member));
    speed = std::max(speed, body.fastest_point());
    scale = std::min(scale, speed_scale(work.scene(), *body.body));
  }
  if (!is_quiet(work, before, speed, scale)) return false;

  // gets faster: not at rest, but perhaps from here on
  if (before.quiet.since == never || speed > before.quiet.speed) {
    group.quiet = {work.now(), speed};
    return false;
  }
  group.quiet = before.quiet;
  return work.now() - before.quiet.since >= answer::rest_time &&
         (speed <= answer::rest_decay * before.quiet.speed || speed <= answer::still_share * scale);
}

std::vector<ProcessId> wakes_with(const Regrouping& work) {
  std::vector<ProcessId> around;
  for (const auto& group : work.made)
    if (group->at_rest && !group->asleep)
      for (const BodyId id : group->outside) {
        const Successor* successor =
            work.scene().body(id).dynamic() ? work.successor_of(id) : nullptr;
        if (successor && !work.changes(successor) && successor->data.group->asleep)
          around.push_back(successor->process());
      }
  return work.before.reached_from(around,
                                  [](const State& s) { return s.group && s.group->asleep; });
}

bool disturbed(const Regrouping& work, const std::vector<ProcessId>& sleepers,
               std::vector<ProcessId>& in_motion) {
  bool found = false;
  work.before.visit_contacts(sleepers, [&](const Group&, const ContactPair& pair, BodyId other) {
    const ProcessId process = work.scene().process_of(other);
    if (holds(sleepers, process) || pair.count == 0) return;
    const Successor* successor = work.successor_of(process);
    const bool changes = work.changes(successor);
    const Group* group = (changes ? successor->data : work.before.state(process)).group.get();
    if (!group || group->at_rest) return;
    found = true;
    if (!changes) insert(in_motion, process);
  });
  return found;
}

}  // namespace tw
