// When group checks happen.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/ends/check-times.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "groups/regroup/step-tolerances.h"
#include "multibody/multibody.h"

namespace tw {
namespace {

// To a power of two of the unit, s.
double on_lattice(double unit, double interval) {
  return std::ldexp(unit, std::ilogb(interval / unit));
}

// The size by which a body asks for checks, m: its least width, and of what is thin half the mean
// of that and of the edge of a cube as far across.  What a check finds anew lies along the wide
// sides, as edges that are passed do; what comes down through the thin one is for the end test.
double check_size(const Body& body) {
  return std::max(body.least_width,
                  answer::thin_check_share * std::sqrt(body.least_width * cube_width(body)));
}

}  // namespace

double check_interval(const Regrouping& work, const std::vector<ProcessId>& members,
                      int doublings) {
  const double gravity = work.scene().gravity_scale();
  const double rate = work.scene().options.group_check_rate;
  const double unit = rate > 0 ? 1 / rate : answer::check_unit;
  double interval = never;
  for (const ProcessId member : members) {
    const PlacedBody body = placed(*work.successor_of(member));
    const double speed = body.surface_speed(), finest = finest_check(work.scene(), *body.body);
    // the longest of the lattice in which it moves no farther: v s + g s^2/2 = distance
    const auto within = [&](double distance) {
      const double root = std::sqrt(speed * speed + 2 * gravity * distance);
      return on_lattice(unit, 2 * distance / (speed + root));
    };
    const double size = check_size(*body.body);
    double asked = within(answer::most_travel * size);
    // what is thin is checked more rarely anyhow than its thickness asks for
    if (doublings > 0 && size <= body.body->least_width)
      asked = std::max(asked, std::min(std::ldexp(asked, doublings),
                                       within(answer::most_foreseen * body.body->least_width)));
    interval =
        std::min(interval, std::clamp(asked, finest, std::ldexp(finest, answer::most_halvings)));
  }
  return interval;
}

double finest_check(const Scene& scene, const Body& body) {
  const double rate = scene.options.group_check_rate;
  if (rate > 0) return 1 / rate;
  return on_lattice(answer::check_unit, answer::finest_check_times *
                                            std::sqrt(check_size(body) / scene.gravity_scale()));
}

double least_arc(const Scene& scene, const std::vector<ProcessId>& members) {
  double finest = never;
  for (const ProcessId member : members)
    if (const Body& body = scene.body_of(member); body.shape_P)
      finest = std::min(finest, finest_check(scene, body));
  return finest < never ? answer::least_arc * finest : 0;
}

double interval_within(const Scene& scene, double time) {
  const double rate = scene.options.group_check_rate;
  return on_lattice(rate > 0 ? 1 / rate : answer::check_unit, time);
}

double joint_check_interval(const Scene& scene, const Multibody& multibody) {
  double size = 0;
  for (const BodyId link : multibody.links) size += extent_of_link(scene.body(link));
  return on_lattice(answer::check_unit, std::sqrt(size / scene.gravity_scale()));
}

double bond_check_interval(const Scene& scene, const Body& body) {
  return on_lattice(answer::check_unit, std::sqrt(body.extent() / scene.gravity_scale()));
}

double call_check_grid(double period) { return on_lattice(answer::check_unit, period / 4); }

double next_check_time(double now, double interval) {
  TW_ASSERT(interval > 0, "checks are apart");
  constexpr double rounding = 1e-9;
  const auto last_within = [&](double unit) {
    return unit * std::floor((now + interval) / unit + rounding);
  };
  const double whole = last_within(interval);
  return whole - now >= (0.5 - rounding) * interval ? whole : last_within(0.5 * interval);
}

double next_common_check_time(double now, double interval) {
  double k = std::floor(now / interval);
  while (!(k * interval > now)) ++k;
  return k * interval;
}

Key group_check_key(const Group& group, double when) {
  const bool starts_now = group.key.time == when;
  return {when, 1 + (starts_now ? group.key.microstep : 0), KeyKind::group_check, 0};
}

Key end_key(const State& state, double when) {
  Key key{when, 1, KeyKind::group_check, number(state.process)};
  if (state.group)
    key.microstep = group_check_key(*state.group, when).microstep;
  else if (state.arc_key.time == when)
    key.microstep += state.arc_key.microstep;
  return key;
}

}  // namespace tw
