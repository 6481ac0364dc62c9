// The planned end of a group's arc.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/planned-end.h"

#include <algorithm>

#include "groups/ends/check-times.h"
#include "integrate/given/moving-base.h"
#include "multibody/multibody.h"

namespace tw {
namespace {

const Body& body_of(const PlannedGroup& p, ProcessId member) {
  return *p.work.successor_of(member)->body;
}

// ---- how long: s from now on, `never` where the reason does not apply ----

double by_motion(const PlannedGroup& p) {
  std::vector<ProcessId> touching;
  for (std::uint32_t i = 0; i < p.group.members.size(); ++i)
    if (!p.group.pairs_of(i).empty()) touching.push_back(p.group.members[i]);
  return check_interval(p.work, touching, p.group.doublings);
}

// What is tied and touches nothing waits for the slowest of it.
double by_ties(const PlannedGroup& p) {
  const Scene& scene = p.work.scene();
  double slowest = 0;
  for (std::uint32_t i = 0; i < p.group.members.size(); ++i) {
    if (!p.group.pairs_of(i).empty()) continue;
    const Body& body = body_of(p, p.group.members[i]);
    slowest = std::max(slowest, body.multibody ? joint_check_interval(scene, *body.multibody)
                                               : bond_check_interval(scene, body));
  }
  return slowest > 0 ? slowest : never;
}

double by_push(const PlannedGroup& p) {
  double finest = never;
  if (std::any_of(p.group.pairs.begin(), p.group.pairs.end(), [&](const ContactPair& pair) {
        return p.contacts.pushes_apart(p.work.scene(), pair);
      }))
    for (const ProcessId member : p.group.members)
      if (const Body& body = body_of(p, member); body.shape_P)
        finest = std::min(finest, finest_check(p.work.scene(), body));
  return finest;
}

// Where blow follows on blow, as when a wave of impacts goes through a lattice, all that is
// integrated beyond the next one is in vain.  So an arc that begins with a blow on what an impact
// gave its arc, or begins at an early check, lasts a number of times what the one before did, and
// the check at its end, where nothing has come, allows that number more.
double by_patience(const PlannedGroup& p, double interval) {
  const Regrouping& work = p.work;
  double patience = never;
  for (const auto& old : work.old) {
    if (old->at_rest || std::none_of(old->members.begin(), old->members.end(),
                                     [&](ProcessId id) { return p.group.contains(id); }))
      continue;
    const double lasted = work.now() - old->key.time;
    if (finds_contacts(work.cause()))
      patience = std::min(patience, answer::patience_growth * old->patience);
    if (lasted > 0 && (work.cause() == Cause::early_check ||
                       (work.cause() == Cause::impact && old->key.kind == KeyKind::impact)))
      patience = std::min(patience, answer::patience_growth * lasted);
  }
  if (!(patience < interval)) return never;
  return interval_within(work.scene(),
                         std::max(patience, least_arc(work.scene(), p.group.members)));
}

struct Interval {
  EndReason reason;
  double (*longest)(const PlannedGroup&);
};
constexpr Interval intervals[] = {
    {EndReason::motion, by_motion}, {EndReason::tied, by_ties}, {EndReason::push, by_push}};

// ---- by when: an instant, `never` where the reason does not apply; `end`: of the rows before ----

double at_border(const PlannedGroup& p, double) { return p.border_end; }

// Soon after the next call of a callback that is handed a member again and again, and is likely to
// give it another arc.  For groups that touch nothing, whose checks wait for nobody.
double at_call(const PlannedGroup& p, double) {
  double period = never;
  if (!p.group.pairs.empty()) return never;
  for (const ProcessId member : p.group.members)
    period = std::min(period, body_of(p, member).callback_period);
  if (!(period < never)) return never;
  return next_check_time(p.work.now() + period, call_check_grid(period));
}

// Where there is something to look at, unless this is it.
double at_due(const PlannedGroup& p, double) {
  if (!p.before || p.group.pairs.empty() || finds_contacts(p.work.cause())) return never;
  const double due = p.before->next_check_at(p.work.now());
  return due >= p.work.now() ? due : never;
}

// Where a base jumps the joints go on with other velocities.
double at_corner(const PlannedGroup& p, double end) {
  double corner = never;
  const Multibody* last = nullptr;
  for (const ProcessId member : p.group.members)
    if (const Multibody* multibody = body_of(p, member).multibody; multibody != last) {
      if (multibody) corner = std::min(corner, next_corner_of(*multibody, p.work.now(), end));
      last = multibody;
    }
  return corner;
}

struct Instant {
  EndReason reason;
  double (*time)(const PlannedGroup&, double end);
  bool of_rest;  // also of what rests
};
constexpr Instant instants[] = {{EndReason::border, at_border, false},
                                {EndReason::call, at_call, false},
                                {EndReason::due, at_due, false},
                                {EndReason::corner, at_corner, true}};

// The shortest interval, laid on the lattice.
EndPlan plan_by_intervals(const PlannedGroup& p) {
  EndPlan plan;
  ArcEnd lasts;
  for (const Interval& row : intervals) lasts = earlier(lasts, {row.longest(p), row.reason});
  plan.patience = by_patience(p, lasts.time);
  lasts = earlier(lasts, {plan.patience, EndReason::patience});
  const double now = p.work.now();
  plan.end = {p.group.has_border ? next_common_check_time(now, lasts.time)
                                 : next_check_time(now, lasts.time),
              lasts.reason};
  return plan;
}

}  // namespace

EndPlan plan_end(const PlannedGroup& p) {
  EndPlan plan;
  if (!p.group.at_rest) plan = plan_by_intervals(p);
  for (const Instant& row : instants)
    if (!p.group.at_rest || row.of_rest)
      plan.end = earlier(plan.end, {row.time(p, plan.end.time), row.reason});
  return plan;
}

ArcEnd plan_birth_end(const Scene& scene, const Multibody& multibody, double now) {
  const ArcEnd end{next_check_time(now, joint_check_interval(scene, multibody)), EndReason::tied};
  return earlier(end, {next_corner_of(multibody, now, end.time), EndReason::corner});
}

}  // namespace tw
