// Steps of explicit methods through what touches nothing: a multibody, bodies on springs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "integrate/bond-equations.h"
#include "integrate/group-rows.h"
#include "integrate/group-stepper.h"
#include "integrate/joint-equations.h"
#include "integrate/runge-kutta.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace rows;

// A multibody that touches nothing is followed by an explicit method where nothing at its joints is
// stiff, or what is stiff swings widely.
void GroupStepper::start_alone() {
  const bool alone = start_.joint_tolerance > 0 && start_.trees.size() == 1 &&
                     start_.contacts.empty() && start_.bonds.empty() &&
                     std::none_of(start_.members.begin(), start_.members.end(),
                                  [](const GroupMember& m) { return m.forces != nullptr; }) &&
                     start_.members.size() == start_.trees.front().members.size();
  if (!alone) return;
  const GroupTree& tree = start_.trees.front();
  nonstiff_ = is_nonstiff(tree, start_.joint_size, start_.joint_rate);
  if (nonstiff_ || swings_widely(start_, start_.time, tree.state->q, tree.state->u)) {
    std::vector<double> y(tree.state->u.size(), 0.0);
    y.insert(y.end(), tree.state->u.begin(), tree.state->u.end());
    explicit_ = std::make_unique<Solution>(
        start_.joint_tolerance > answer::loose_steps ? tsit5 : dop853,
        std::make_unique<JointEquations>(tree, start_.end, start_.joint_tolerance,
                                         start_.joint_size, start_.joint_rate),
        start_.time, std::move(y), tree.state->q);
  }
}

// Whether bodies on springs swing widely at the last node; their state there is in the scratch.
bool GroupStepper::swings_here() {
  GroupScratch& s = system_.scratch();
  const double time = record_.reached();
  system_.set_outside(time, s.bodies);
  record_.load_last(system_, s.state.data());
  system_.linearise(time, s.state.data(), s, s.slope.data());
  counts_.evaluations += 2;
  return swings_widely(start_, system_, s, time, s.state.data(), s.slope.data(), s.trial.data());
}

// Bodies on springs by an explicit method where they swing widely.
void GroupStepper::choose_method() {
  chosen_ = true;
  if (explicit_ || !is_tied_by_springs(start_, system_) || !swings_here()) return;
  const double* at_start = system_.scratch().state.data();
  std::vector<double> y(at_start, at_start + system_.size()), chart(4 * start_.members.size());
  for (std::size_t i = 0; i < start_.members.size(); ++i)
    store(start_.members[i].q, chart.data() + 4 * i);
  explicit_ = std::make_unique<Solution>(dop853, std::make_unique<BondEquations>(start_, system_),
                                         start_.time, std::move(y), std::move(chart));
}

// Once nothing swings any longer, RODAS4 goes on from the last node.
void GroupStepper::leave_explicit() {
  counts_ = counts();
  explicit_.reset();
  next_step_ = 0;
}

bool GroupStepper::extend_explicit(double from, double latest) {
  if (explicit_->extend(from, latest) && explicit_->reached() > from) return true;
  failure_ = explicit_->failure() ? explicit_->failure() : "no step";
  return false;
}

// Of a multibody that touches nothing: one step, the last one as far as the end.
bool GroupStepper::tree_step() {
  if (record_.numbers() > guard::most_arc_numbers) return failure_ = "too many steps", false;
  const double from = record_.reached();
  if (!extend_explicit(from)) return false;
  const DenseStep& step = explicit_->at(from);
  const double to = std::min(explicit_->reached(), start_.end);
  const double share = (to - from) / (step.end() - step.start());
  TreeInGroup& tree = *system_.trees().front();
  const std::size_t n = static_cast<std::size_t>(tree.freedoms());
  std::vector<double> powers = step.powers();
  const std::size_t degree = powers.size() / (2 * n) - 1;
  std::vector<double> end(powers.begin(), powers.begin() + static_cast<std::ptrdiff_t>(n));
  double scale = 1;
  for (std::size_t k = 1; k <= degree; ++k) {
    scale *= share;
    for (std::size_t e = 0; e < 2 * n; ++e) powers[2 * n * k + e] *= scale;
    for (std::size_t e = 0; e < n; ++e) end[e] += powers[2 * n * k + e];
  }
  joints_.front().joints(from, joint_positions_, joint_velocities_);
  tree.set_positions(joint_positions_);
  joints_.front().append(to, powers, tree.displaced(end.data()));
  GroupScratch& s = system_.scratch();
  record_.load_last(system_, s.trial.data());
  std::fill_n(s.stage[4].data(), system_.size(), 0.0);
  record_.append(to, system_, s.trial.data(), s.stage[4].data(), s.stage[4].data());
  next_step_ = 0;
  if (!nonstiff_ && explicit_->counts().steps % answer::steps_between_choices == 0) {
    joints_.front().joints(to, joint_positions_, joint_velocities_);
    if (!swings_widely(start_, to, joint_positions_, joint_velocities_)) leave_explicit();
  }
  return true;
}

// Cubics of the record follow a polynomial of degree 7 in parts.  The error of a cubic with the
// values and rates of its ends is largest near its middle and falls with the fourth power of its
// length: in tolerances, from a few parts on.
int GroupStepper::parts_of(const DenseStep& step, double from, double to) const {
  constexpr int tried = 4;
  const double h = (to - from) / tried;
  double worst = 0;
  for (int i = 0; i < tried; ++i) {
    const double t0 = from + i * h, t1 = i + 1 < tried ? t0 + h : to, middle = 0.5 * (t0 + t1);
    const auto error = [&](int value, int rate, bool is_rate) -> double {
      const auto slope = [&](double t) -> Vec3 {
        return is_rate ? step.vector_rate(rate, t) : step.vector(rate, t);
      };
      const Vec3 cubic = 0.5 * (step.vector(value, t0) + step.vector(value, t1)) +
                         0.125 * (t1 - t0) * (slope(t0) - slope(t1));
      return (cubic - step.vector(value, middle)).norm();
    };
    for (int m = 0; m < system_.members(); ++m) {
      const GroupMember& member = start_.members[index(m)];
      const int at = 12 * m;
      const double turning = member.radius / member.moments.minCoeff();
      worst = std::max({worst, error(at, at + 6, false) / start_.position_tolerance,
                        error(at + 3, at + 3, true) * member.radius / start_.position_tolerance,
                        error(at + 6, at + 6, true) / start_.velocity_tolerance,
                        error(at + 9, at + 9, true) * turning / start_.velocity_tolerance});
    }
  }
  const double parts = std::ceil(tried * std::sqrt(std::sqrt(worst)));
  return static_cast<int>(std::clamp(parts, 1.0, answer::most_parts));
}

// Of bodies on springs: one step.  The last one ends where the arc does: within a step polynomials
// err by more than at its end.
bool GroupStepper::spring_step() {
  if (record_.numbers() > guard::most_arc_numbers) return failure_ = "too many steps", false;
  const double from = record_.reached();
  if (!extend_explicit(from, start_.end)) return false;
  const DenseStep& step = explicit_->at(from);
  const double to = explicit_->reached();
  const int parts = parts_of(step, from, to);
  GroupScratch& s = system_.scratch();
  for (int i = 1; i <= parts; ++i) {
    const double t0 = record_.reached(), t1 = i < parts ? from + (to - from) * i / parts : to;
    record_.load_last(system_, s.state.data());
    const double h = t1 - t0;
    double *y1 = s.trial.data(), *d3 = s.stage[4].data(), *d4 = s.stage[5].data();
    for (int m = 0; m < system_.members(); ++m) {
      const int at = 12 * m;
      const Quat q = short_rotation(step.vector(at + 3, t1)) * quat(step.chart() + 4 * m);
      vec(y1 + at) = step.vector(at, t1);
      vec(y1 + at + 3) = turn_between(system_.attitude(m), q);
      // (1-r) y0 + r (y1 + (1-r)(D3 + r D4)) with the rates of both ends
      for (const int row : {at + 6, at + 9}) {
        const Vec3 end = step.vector(row, t1), change = end - vec(s.state.data() + row);
        const Vec3 first = h * step.vector_rate(row, t0) - change;
        vec(y1 + row) = end;
        vec(d3 + row) = first;
        vec(d4 + row) = change - first - h * step.vector_rate(row, t1);
      }
    }
    record_.append(t1, system_, y1, d3, d4);
  }
  next_step_ = 0;
  if (explicit_->counts().steps % answer::steps_between_choices == 0 && !swings_here())
    leave_explicit();
  return true;
}

}  // namespace tw
