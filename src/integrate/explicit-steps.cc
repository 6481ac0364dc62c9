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
#include "integrate/step-polynomials.h"
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
  system_.set_outside(time, s);
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

// Cubics of the record follow a polynomial of higher degree in parts.  One with the values and
// rates of its ends errs by |y''''| l^4/384 over a length l: the number of parts by which that is
// within the tolerances, as fourth derivatives are at four places of the step.  `powers` as of
// DenseStep.
int GroupStepper::parts_of(const std::vector<double>& powers) const {
  const std::size_t size = 12 * start_.members.size();
  const std::size_t degree = powers.size() / size - 1;
  double worst = 0;
  for (const double r : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
    const auto fourth = [&](std::size_t first) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = degree; k >= 4; --k)
        sum = r * sum + static_cast<double>(k * (k - 1) * (k - 2) * (k - 3)) *
                            vec(powers.data() + size * k + first);
      return sum.norm();
    };
    for (std::size_t m = 0; m < start_.members.size(); ++m) {
      const GroupMember& member = start_.members[m];
      const std::size_t at = 12 * m;
      const double turning = member.radius / member.moments.minCoeff();
      worst = std::max({worst, fourth(at) / start_.position_tolerance,
                        fourth(at + 3) * member.radius / start_.position_tolerance,
                        fourth(at + 6) / start_.velocity_tolerance,
                        fourth(at + 9) * turning / start_.velocity_tolerance});
    }
  }
  const double parts = std::ceil(std::sqrt(std::sqrt(worst / 384)));
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
  const std::vector<double> powers = step.powers();
  const int parts = parts_of(powers), size = 12 * system_.members();
  StepPolynomials whole(from, size, step.degree());
  whole.append(to, powers);
  std::vector<double> y(index(size)), rates(index(size)), rates_before(index(size));
  whole.rates(0, 0, rates_before.data());
  GroupScratch& s = system_.scratch();
  for (int i = 1; i <= parts; ++i) {
    const double t0 = record_.reached(), t1 = i < parts ? from + (to - from) * i / parts : to;
    const double h = t1 - t0, r = i < parts ? whole.fraction(0, t1) : 1;
    whole.values(0, r, y.data());
    whole.rates(0, r, rates.data());
    record_.load_last(system_, s.state.data());
    double *y1 = s.trial.data(), *d3 = s.stage[4].data(), *d4 = s.stage[5].data();
    for (int m = 0; m < system_.members(); ++m) {
      const int at = 12 * m;
      const Quat q = short_rotation(vec(y.data() + at + 3)) * quat(step.chart() + 4 * m);
      vec(y1 + at) = vec(y.data() + at);
      vec(y1 + at + 3) = turn_between(system_.attitude(m), q);
      // (1-r) y0 + r (y1 + (1-r)(D3 + r D4)) with the rates of both ends
      for (const int row : {at + 6, at + 9}) {
        const Vec3 end = vec(y.data() + row), change = end - vec(s.state.data() + row);
        const Vec3 first = h * vec(rates_before.data() + row) - change;
        vec(y1 + row) = end;
        vec(d3 + row) = first;
        vec(d4 + row) = change - first - h * vec(rates.data() + row);
      }
    }
    record_.append(t1, system_, y1, d3, d4);
    std::swap(rates, rates_before);
  }
  next_step_ = 0;
  if (explicit_->counts().steps % answer::steps_between_choices == 0 && !swings_here())
    leave_explicit();
  return true;
}

}  // namespace tw
