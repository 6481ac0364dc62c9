// The equations of bodies that springs alone tie to each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/bond-equations.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "integrate/group-rows.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace rows;

namespace {

constexpr int theta_at = 3, v_at = 6, L_at = 9;

Quat chart_attitude(const double* chart) { return Quat(chart[0], chart[1], chart[2], chart[3]); }

void set_chart(const Quat& q, double* chart) {
  chart[0] = q.w();
  chart[1] = q.x();
  chart[2] = q.y();
  chart[3] = q.z();
}

}  // namespace

void BondEquations::slope(double time, const double* y, const double* chart, double* slope) const {
  for (int i = 0; i < system_.members(); ++i)
    system_.set_attitude(i, chart_attitude(chart + 4 * i));
  GroupScratch& scratch = system_.scratch();
  system_.set_outside(time, scratch.bodies);
  system_.evaluate(time, y, scratch, slope);
}

void BondEquations::tolerances(const double*, const double*, double* allowed) const {
  for (const GroupMember& m : start_.members) {
    std::fill_n(allowed, 3, start_.position_tolerance);
    std::fill_n(allowed + theta_at, 3, start_.position_tolerance / m.radius);
    std::fill_n(allowed + v_at, 3, start_.velocity_tolerance);
    std::fill_n(allowed + L_at, 3, start_.velocity_tolerance * m.moments.minCoeff() / m.radius);
    allowed += 12;
  }
}

double BondEquations::longest_step(const double*, const double* slope, const double*) const {
  double turn = 0;
  for (int i = 0; i < system_.members(); ++i)
    turn = std::max(turn, vec(slope + 12 * i + theta_at).norm());
  return std::min(start_.end - start_.time, answer::most_step_turn / turn);
}

void BondEquations::recentre(double* y, double* slope, double* chart) const {
  for (int i = 0; i < system_.members(); ++i, y += 12, slope += 12, chart += 4) {
    const Quat q = (short_rotation(vec(y + theta_at)) * chart_attitude(chart)).normalized();
    set_chart(q, chart);
    vec(y + theta_at).setZero();
    // theta' = w where theta = 0
    vec(slope + theta_at) = system_.angular_velocity(i, q, vec(y + L_at));
  }
}

bool is_tied_by_springs(const GroupStart& start, const GroupSystem& system) {
  const auto holds = [](const GroupBond& tied) { return tied.bond->holds; };
  return !start.bonds.empty() && start.contacts.empty() && start.trees.empty() &&
         !system.moved_from_outside() &&
         std::none_of(start.bonds.begin(), start.bonds.end(), holds);
}

// With the fastest swing omega RODAS4 takes steps of
//   h omega = (C tolerance/V)^(1/4)
// through one whose velocity has the amplitude V (first_step of group-stepper.cc).  V follows from
// how the ends of springs accelerate against each other and how that changes: what hangs still, or
// falls, does neither.
bool swings_widely(const GroupStart& start, const GroupSystem& system, GroupScratch& scratch,
                   const double* y, const double* slope, double* other) {
  const GroupSystem::SpringRates rates = system.spring_rates();
  const double omega = std::sqrt(rates.squared_frequency);
  if (rates.damping > answer::most_explicit_damping * omega) return false;
  if (!(omega > 0)) return true;

  // slopes a part of a swing later
  const double h = 1e-3 / omega;
  std::vector<double> later(system.size());
  for (std::size_t e = 0; e < system.size(); ++e) later[e] = y[e] + h * slope[e];
  system.set_outside(start.time, scratch.bodies);
  system.evaluate(start.time, later.data(), scratch, other);
  double widest = 0;
  const auto note = [&](const Vec3& now, const Vec3& then) {
    widest = std::max({widest, now.norm() / omega, (then - now).norm() / (h * omega * omega)});
  };
  const auto acceleration = [&](const double* of, int body, const Vec3& arm) -> Vec3 {
    const GroupMember& m = start.members[index(body)];
    const Vec3 turning = vec(of + 12 * body + L_at) / m.moments.minCoeff();
    return vec(of + 12 * body + v_at) + turning.cross(m.q * arm);
  };
  for (const auto& [a, b, bond] : start.bonds)
    note(acceleration(slope, b, bond->arm_b) - acceleration(slope, a, bond->arm_a),
         acceleration(other, b, bond->arm_b) - acceleration(other, a, bond->arm_a));
  for (int i = 0; i < system.members(); ++i) {
    const GroupMember& m = start.members[index(i)];
    const Vec3 arm = Vec3::UnitX() * m.radius;
    if (m.forces) note(acceleration(slope, i, arm), acceleration(other, i, arm));
  }
  const double fourth = answer::first_step_error * start.velocity_tolerance / widest;
  return std::sqrt(std::sqrt(fourth)) < answer::explicit_swing;
}

}  // namespace tw
