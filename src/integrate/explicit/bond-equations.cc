// The equations of bodies that springs alone tie to each other.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/bond-equations.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "integrate/implicit/group-rows.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace rows;

namespace {

constexpr int theta_at = 3, v_at = 6, L_at = 9;

}  // namespace

void BondEquations::slope(double time, const double* y, const double* chart, double* slope) const {
  for (int i = 0; i < system_.members(); ++i) system_.set_attitude(i, quat(chart + 4 * i));
  GroupScratch& scratch = system_.scratch();
  system_.set_outside(time, scratch);
  system_.evaluate(time, y, scratch, slope);
}

void BondEquations::tolerances(const double*, const double*, double* allowed) const {
  const double far = answer::explicit_share * start_.position_tolerance;
  const double fast = answer::explicit_share * start_.velocity_tolerance;
  for (const GroupMember& m : start_.members) {
    std::fill_n(allowed, 3, far);
    std::fill_n(allowed + theta_at, 3, far / m.radius);
    std::fill_n(allowed + v_at, 3, fast);
    std::fill_n(allowed + L_at, 3, fast * m.moments.minCoeff() / m.radius);
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
    const Quat q = (short_rotation(vec(y + theta_at)) * quat(chart)).normalized();
    store(q, chart);
    vec(y + theta_at).setZero();
    // theta' = w where theta = 0
    vec(slope + theta_at) = system_.angular_velocity(i, q, vec(y + L_at));
  }
}

bool is_tied_by_springs(const GroupStart& start, const GroupSystem& system) {
  const auto holds = [](const Bond* bond) { return bond && bond->holds; };
  for (const GroupBond& tied : start.bonds)
    if (holds(tied.bond.get())) return false;
  for (const GroupMember& m : start.members)
    if (m.forces)
      for (const ForceLawPtr& law : m.forces->laws())
        if (holds(law->bond())) return false;
  return !start.bonds.empty() && start.contacts.empty() && start.trees.empty() &&
         !system.moved_from_outside();
}

namespace {

// The length of a spring, or what it is long as a vector where it has no rest length: how fast its
// change changes, m/s^2.
class Stretching {
 public:
  Stretching(const GroupSystem& system, const double* y, const double* slope)
      : system_(system), y_(y), slope_(slope) {}

  // l'' = u.(a_b - a_a) + |v_across|^2/l: nothing where two turn about each other, or fall.
  Vec3 operator()(const GroupBond& tied) const {
    const Point a = point(tied.a, tied.bond->arm_a), b = point(tied.b, tied.bond->arm_b);
    const Vec3 d = b.x - a.x, change = b.a - a.a;
    const double l = d.norm();
    if (tied.bond->spring.rest == 0 || l == 0) return change;
    const Vec3 u = d / l, v = b.v - a.v;
    return Vec3::UnitX() * (u.dot(change) + (v - u.dot(v) * u).squaredNorm() / l);
  }

 private:
  struct Point {
    Vec3 x, v, a;
  };
  Point point(int body, const Vec3& arm) const {
    const double *y = y_ + 12 * body, *slope = slope_ + 12 * body;
    const Quat q = short_rotation(vec(y + theta_at)) * system_.attitude(body);
    const Vec3 r = q * arm, L = vec(y + L_at), w = system_.angular_velocity(body, q, L);
    const Vec3 turning = system_.angular_velocity(body, q, vec(slope + L_at) - w.cross(L));
    return {vec(y) + r, vec(y + v_at) + w.cross(r),
            vec(slope + v_at) + turning.cross(r) + w.cross(w.cross(r))};
  }

  const GroupSystem& system_;
  const double *y_, *slope_;
};

}  // namespace

// RODAS4 takes steps of
//   h = (C tolerance/V)^(1/4)/omega
// through a swing of frequency omega whose velocity has the amplitude V (first_step of
// rodas-steps.cc), the explicit method steps of about a radian of the fastest swing there is,
// whether anything swings so or not.  V follows from l'' and how it changes: one of the two is
// large at any phase.
bool swings_widely(const GroupStart& start, const GroupSystem& system, GroupScratch& scratch,
                   double time, const double* y, const double* slope, double* other) {
  const GroupSystem::SpringRates rates = system.spring_rates(scratch);
  const double fastest = std::sqrt(rates.squared_frequency);
  if (!(fastest > 0) || rates.damping > answer::most_explicit_damping * fastest) return false;

  // slopes a part of a swing later
  const double h = 1e-3 / fastest;
  std::vector<double> later(system.size());
  for (std::size_t e = 0; e < system.size(); ++e) later[e] = y[e] + h * slope[e];
  system.set_outside(time, scratch);
  system.evaluate(time, later.data(), scratch, other);
  const Stretching now(system, y, slope), then(system, later.data(), other);
  double shortest = never;
  for (std::size_t i = 0; i < start.bonds.size(); ++i) {
    const double squared = system.squared_frequency_of(static_cast<int>(i));
    if (!(squared > 0)) continue;
    const double omega = std::sqrt(squared);
    const Vec3 first = now(start.bonds[i]), change = then(start.bonds[i]) - first;
    const double widest = std::max(first.norm() / omega, change.norm() / (h * squared));
    const double fourth = answer::first_step_error * start.velocity_tolerance / widest;
    shortest = std::min(shortest, std::sqrt(std::sqrt(fourth)) / omega);
  }
  return shortest * fastest < answer::explicit_swing;
}

}  // namespace tw
