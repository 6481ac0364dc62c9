// The stops of joints at a discontinuity.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "groups/joints/joint-stops.h"

#include <cmath>

#include "base/constants.h"
#include "groups/joints/joints.h"
#include "multibody/impulses.h"
#include "multibody/limits.h"

namespace tw {

using namespace multibody;

namespace {

// One axis against the limit that is nearer.
struct AtStop {
  Stop stop = Stop::none;
  double side = 0;   // 1: at the lower limit; the way out
  double gap = 0;    // negative: beyond
  double speed = 0;  // towards it
  bool touches = false;

  AtStop(const Axis& axis, const MultibodyState& joints) {
    // most joints have none
    if (!std::isfinite(axis.law.lower) && !std::isfinite(axis.law.upper)) return;
    const double q = limited(axis, joints.q);
    const bool low = q - axis.law.lower <= axis.law.upper - q;
    const double limit = low ? axis.law.lower : axis.law.upper;
    if (!std::isfinite(limit)) return;
    stop = low ? Stop::lower : Stop::upper;
    side = low ? 1 : -1;
    gap = side * (q - limit);
    speed = -side * limited_rate(axis, joints.q, joints.u);
    touches = gap <= stop_tolerance(axis, limit);
  }
};

// The change of what is limited by a unit impulse along it; `work`, `force`: room.
double inverse_inertia_of_limited(const Factored& factored, const Axis& axis, In q,
                                  ImpulseWork& work, std::vector<double>& force) {
  if (!axis.ball) return inverse_inertia_of_dof(factored, axis.u);
  set_along_limited(axis, q, 1, force);
  velocity_change(factored, {}, force, work, force);
  return limited_rate(axis, q, force);
}

// Impulses at the stops that are struck, the fastest first.
void strike(const Multibody& multibody, double now, MultibodyState& joints) {
  const Tree& tree = multibody.tree;
  std::unique_ptr<PlacedJoints> placed;
  Articulation factors(tree);
  ImpulseWork work(tree);
  std::vector<double> change(joints.u.size());
  for (int count = 0; count < guard::most_stop_impulses; ++count) {
    const Axis* struck = nullptr;
    double fastest = 0;  // of what is slow there
    for (std::size_t i = 0; i < tree.axes().size(); ++i) {
      const Axis& axis = tree.axes()[i];
      const AtStop at(axis, joints);
      if (!at.touches || joints.stops[i] == at.stop) continue;
      if (!(at.speed > std::max(1.0, fastest) * stop_speed(axis))) continue;
      struck = &axis;
      fastest = at.speed / stop_speed(axis);
    }
    if (!struck) return;
    if (!placed) {
      placed = std::make_unique<PlacedJoints>(multibody, joints, now);
      factor(tree, placed->kinematics(), factors);
    }
    const Factored factored{tree, placed->kinematics(), factors};
    const AtStop at(*struck, joints);
    const double impulse = (1 + struck->law.restitution) * at.speed * at.side /
                           inverse_inertia_of_limited(factored, *struck, joints.q, work, change);
    set_along_limited(*struck, joints.q, impulse, change);
    velocity_change(factored, {}, change, work, change);
    for (std::size_t k = 0; k < change.size(); ++k) joints.u[k] += change[k];
  }
}

}  // namespace

std::vector<LeaningStop> leaning_stops(const Multibody& multibody, const MultibodyState& joints) {
  std::vector<LeaningStop> all;
  const std::vector<Axis>& axes = multibody.tree.axes();
  for (std::size_t i = 0; i < joints.stops.size(); ++i) {
    if (joints.stops[i] == Stop::none) continue;
    const AtStop at(axes[i], joints);
    if (at.stop == joints.stops[i] && at.gap < 0) all.push_back({&axes[i], at.side});
  }
  return all;
}

void settle_stops(const Multibody& multibody, double now, bool may_leave, MultibodyState& joints) {
  const std::vector<Axis>& axes = multibody.tree.axes();
  bool any = false;
  for (const Axis& axis : axes) any = any || AtStop(axis, joints).touches;
  if (!any && joints.stops.empty()) return;
  joints.stops.resize(axes.size(), Stop::none);
  strike(multibody, now, joints);
  // rounding of an impulse that leaves nothing
  constexpr double nothing = 1e-6;  // of what is slow
  bool leans = false;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AtStop at(axes[i], joints);
    if (at.touches && joints.stops[i] != at.stop && at.speed > -nothing * stop_speed(axes[i]))
      joints.stops[i] = at.stop;
    else if (may_leave && !at.touches && at.speed < 0)
      joints.stops[i] = Stop::none;
    leans = leans || joints.stops[i] != Stop::none;
  }
  if (!leans) joints.stops.clear();
}

}  // namespace tw
