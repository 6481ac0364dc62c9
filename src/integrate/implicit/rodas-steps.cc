// Steps of RODAS4 through a contact group.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/rodas-steps.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/constants.h"
#include "integrate/explicit/joint-equations.h"
#include "integrate/implicit/group-rows.h"
#include "integrate/implicit/rodas4.h"

namespace tw {
namespace {

TW_LANES Lanes load_four(const double* from) {
  Lanes four;
  std::memcpy(&four, from, sizeof four);
  return four;
}
TW_LANES void store_lanes(Lanes four, double* to) { std::memcpy(to, &four, sizeof four); }

// first + sum_j<n weights[j] rows[j], at number e and the three after it, added in this order.
template <int n>
TW_LANES Lanes weighted_sum(Lanes first, const double (&weights)[rodas4::stages - 1],
                            const double* const (&rows)[rodas4::stages], std::size_t e) {
  Lanes sum = first;
  [&]<int... j>(std::integer_sequence<int, j...>) __attribute__((always_inline)) {
    ((sum += lanes(weights[j]) * load_four(rows[j] + e)), ...);
  }
  (std::make_integer_sequence<int, n>());
  return sum;
}

// The last rejected try of a step: its length, s, and error over tolerance.
class Rejection {
 public:
  double cut(double h, double error);

 private:
  double h_ = 0, error_ = 0;
};

class RodasSteps final : public StepMethod {
 public:
  explicit RodasSteps(ArcWork& work)
      : work_(work), start_(work.start), system_(work.system), counts_(work.counts) {}
  const char* step() override;

 private:
  double first_step(GroupScratch& s) const;
  double unforeseen(double h, GroupScratch& s) const;
  double friction_doubt(const GroupScratch& s) const;
  template <int i>
  bool set_stage(double h, GroupScratch& s);
  bool try_step(double h, GroupScratch& s, double& error);
  bool breaks_away(double h, int pressed_hard, GroupScratch& s) const;
  double error_norm(const GroupScratch& s) const;
  double fastest_turn(const GroupScratch& s) const;
  double velocity_change(const GroupScratch& s) const;
  struct Begun {
    double h;          // s, to try first
    int pressed_hard;  // contacts, at the node
  };
  Begun begin(GroupScratch& s);
  void accept(double time, GroupScratch& s);
  void load_joints(GroupScratch& s);
  void append_joints(double time, GroupScratch& s);

  ArcWork& work_;
  const GroupStart& start_;
  GroupSystem& system_;
  GroupCounts& counts_;
  std::vector<double> joint_positions_, joint_velocities_;
};

// A step for a group of which nothing is known.  Contacts oscillate at about omega, omega^2 = the
// largest sum of |dN/dd|, or of k where they touch at most, over a member's mass, joints as their
// springs and stops over what these move; the jerk j = dv'/dt then makes an error of about
// omega^2 j h^4/answer::first_step_error in v.
double RodasSteps::first_step(GroupScratch& s) const {
  double squared = system_.squared_frequency(s);
  for (const GroupTree& tree : start_.trees)
    squared = std::max(squared, joint_rates(tree).squared_frequency);
  const double left = start_.end - start_.time;
  if (!(squared > 0)) return left;

  // the jerk, by a difference along y'
  const double h = 1e-3 / std::sqrt(squared);
  for (std::size_t e = 0; e < system_.size(); ++e) s.trial[e] = s.state[e] + h * s.slope[e];
  double* slope = s.stage[0].data();
  system_.evaluate(start_.time, s.trial.data(), s, slope);
  double jerk = 0;
  for (int i = 0; i < system_.members(); ++i) {
    const GroupMember& m = start_.members[static_cast<std::size_t>(i)];
    for (int j = 6; j < 9; ++j) {
      const double dv = slope[12 * i + j] - s.slope[static_cast<std::size_t>(12 * i + j)];
      const double dL = slope[12 * i + j + 3] - s.slope[static_cast<std::size_t>(12 * i + j + 3)];
      jerk =
          std::max({jerk, std::abs(dv) / h, std::abs(dL) * m.radius / (h * m.moments.minCoeff())});
    }
  }
  for (std::size_t t = 0; t < work_.joints.size(); ++t) {
    const TreeInGroup& tree = *system_.trees()[t];
    const std::size_t n = static_cast<std::size_t>(tree.freedoms());
    const std::size_t u = system_.tree_row(t) + n;
    std::vector<double> change(n), still(n, 0.0);
    for (std::size_t k = 0; k < n; ++k) change[k] = (slope[u + k] - s.slope[u + k]) / h;
    tree.spread(still.data(), change.data(), s.changes.data());
    for (const int member : tree.start().members) {
      const BodyChange& jerks = s.changes[static_cast<std::size_t>(member)];
      const double radius = start_.members[static_cast<std::size_t>(member)].radius;
      jerk = std::max({jerk, rows::vec(jerks.v).norm(), rows::vec(jerks.w).norm() * radius});
    }
  }
  const double fourth = answer::first_step_error * start_.velocity_tolerance / (squared * jerk);
  return std::min(left, std::sqrt(std::sqrt(fourth)));
}

// U_i of rodas4.h
template <int i>
bool RodasSteps::set_stage(double h, GroupScratch& s) {
  using namespace rodas4;
  const std::size_t size = system_.size();
  double* U = s.stage[i].data();
  const double* earlier[stages];
  for (int j = 0; j < stages; ++j) earlier[j] = s.stage[j].data();
  if constexpr (i == 0) {
    std::copy_n(s.slope.data(), size, U);
  } else {
    // y0 + sum a_ij U_j
    double* y = s.trial.data();
    const double* y0 = s.state.data();
    for (std::size_t e = 0; e < size; e += lane_count)
      store_lanes(weighted_sum<i>(load_four(y0 + e), a[i], earlier, e), y + e);
    system_.evaluate(work_.record.reached() + alpha[i] * h, y, s, U);
    ++counts_.evaluations;
    const Lanes rate = lanes(1 / h);
    for (std::size_t e = 0; e < size; e += lane_count)
      store_lanes(load_four(U + e) + rate * weighted_sum<i>(lanes(0), c[i], earlier, e), U + e);
  }
  if (system_.moved_from_outside() && gamma_i[i] != 0)
    for (std::size_t e = 0; e < size; ++e) U[e] += h * gamma_i[i] * s.time_slope[e];
  return system_.solve(s, U);
}

// the stages at a step h; error over tolerance (not finite: no good)
bool RodasSteps::try_step(double h, GroupScratch& s, double& error) {
  if (!system_.factor(1 / (rodas4::gamma * h), s)) return false;
  if (!set_stage<0>(h, s) || !set_stage<1>(h, s) || !set_stage<2>(h, s) || !set_stage<3>(h, s) ||
      !set_stage<4>(h, s) || !set_stage<5>(h, s))
    return false;

  // y1 = y6 + U6
  double sum = 0;
  for (std::size_t e = 0; e < system_.size(); ++e) {
    s.trial[e] += s.stage[5][e];
    sum += s.trial[e];
  }
  error = error_norm(s);
  return std::isfinite(error + sum);
}

// RMS over members and over the four parts, of the changes that the last stage left.  A turn about
// a principal axis counts at twice the radius of gyration, the body's radius at most: what is
// slender moves little by its roll.
double RodasSteps::error_norm(const GroupScratch& s) const {
  double positions = 0, velocities = 0;
  for (int i = 0; i < system_.members(); ++i) {
    const BodyChange& e = s.changes[static_cast<std::size_t>(i)];
    const GroupMember& m = start_.members[static_cast<std::size_t>(i)];
    const double* R = s.bodies[static_cast<std::size_t>(i)].R;
    for (int j = 0; j < 3; ++j) {
      const double lever = std::min(4 * m.moments[j] / m.mass, m.radius * m.radius);  // squared
      const auto along = [&](const double* v) {
        return R[j] * v[0] + R[3 + j] * v[1] + R[6 + j] * v[2];
      };
      const double th = along(e.th), w = along(e.w);
      positions += e.x[j] * e.x[j] + lever * th * th;
      velocities += e.v[j] * e.v[j] + lever * w * w;
    }
  }
  const double p = start_.position_tolerance, v = start_.velocity_tolerance;
  return std::sqrt((positions / (p * p) + velocities / (v * v)) /
                   (4.0 * std::max(system_.members(), 1)));
}

// What the laws at the joints do that was not in the matrix, over tolerance, where friction lets go
// or a stop opens within the step: they are stiff, and the error is damped by a stiffness that is
// there no more.
double RodasSteps::unforeseen(double h, GroupScratch& s) const {
  if (work_.joints.empty()) return 0;
  std::fill(s.changes.begin(), s.changes.end(), BodyChange{});
  bool any = false;
  for (std::size_t t = 0; t < work_.joints.size(); ++t) {
    TreeInGroup& tree = *system_.trees()[t];
    const std::size_t z = system_.tree_row(t), u = z + static_cast<std::size_t>(tree.freedoms());
    any |= tree.add_unforeseen(h, s.state.data() + u, s.trial.data() + z, s.trial.data() + u,
                               s.changes.data());
  }
  return any ? error_norm(s) : 0;
}

// Errors of joints that friction brings to rest, against their velocities.  What is slower than the
// tolerance may go to and fro at the steps' own rate for ever, each step as short as its error is
// large; a few short ones bring it to where friction holds it, and is in the matrix.
double RodasSteps::friction_doubt(const GroupScratch& s) const {
  double worst = 0;
  for (std::size_t t = 0; t < work_.joints.size(); ++t) {
    const TreeInGroup& tree = *system_.trees()[t];
    const std::size_t u = system_.tree_row(t) + static_cast<std::size_t>(tree.freedoms());
    worst = std::max(worst, tree.friction_doubt(s.state.data() + u, s.stage[5].data() + u));
  }
  return worst;
}

// What a rejected step is to be cut by.  Its error goes as h^4 where all is smooth, but as h to h^3
// where a contact opens, closes or begins to slip within it: from the second one on the last two
// say how, to a whole power.
double Rejection::cut(double h, double error) {
  int order = 4;
  double least = answer::least_step_change;
  if (error_ > 0 && h < h_) {
    order = 1;
    const double ratio = h / h_;
    for (double fallen = error_ * ratio * std::sqrt(ratio); order < 4 && error < fallen; ++order)
      fallen *= ratio;
    least = answer::least_repeated_change;
  }
  h_ = h;
  error_ = error;
  const double root = order == 1   ? error
                      : order == 2 ? std::sqrt(error)
                      : order == 3 ? std::cbrt(error)
                                   : std::sqrt(std::sqrt(error));
  return std::clamp(answer::step_safety / root, least, 0.9);
}

// The largest of a member in the step, over tolerance.  Where what pressed hard lets go within a
// step, the error is damped by a stiffness that is there no more: such a step is to do little.
double RodasSteps::velocity_change(const GroupScratch& s) const {
  double most = 0;
  for (int i = 0; i < system_.members(); ++i) {
    const double *from = s.state.data() + 12 * i + 6, *to = s.trial.data() + 12 * i + 6;
    most = std::max(most, (rows::vec(to) - rows::vec(from)).norm());
  }
  return most / start_.velocity_tolerance;
}

double RodasSteps::fastest_turn(const GroupScratch& s) const {
  double squared = 0;
  for (int i = 0; i < system_.members(); ++i) {
    const double* w = s.bodies[static_cast<std::size_t>(i)].w;
    squared = std::max(squared, w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  }
  return std::sqrt(squared);
}

void RodasSteps::accept(double time, GroupScratch& s) {
  // D3 and D4 in the place of stages that are not needed any more
  const std::size_t size = system_.size();
  double *d3 = s.stage[4].data(), *d4 = s.stage[5].data();
  const double* rows[rodas4::stages];
  for (int j = 0; j < rodas4::stages; ++j) rows[j] = s.stage[j].data();
  for (std::size_t e = 0; e < size; e += lane_count) {
    constexpr int used = rodas4::stages - 1;
    const Lanes sum3 = weighted_sum<used>(lanes(0), rodas4::d3, rows, e);
    const Lanes sum4 = weighted_sum<used>(lanes(0), rodas4::d4, rows, e);
    store_lanes(sum3, d3 + e);
    store_lanes(sum4, d4 + e);
  }
  append_joints(time, s);
  work_.record.append(time, system_, s.trial.data(), d3, d4);
}

// Of the step that begins at the last node.
void RodasSteps::load_joints(GroupScratch& s) {
  for (std::size_t t = 0; t < work_.joints.size(); ++t) {
    TreeInGroup& tree = *system_.trees()[t];
    double* row = s.state.data() + system_.tree_row(t);
    work_.joints[t].joints(work_.record.reached(), joint_positions_, joint_velocities_);
    tree.set_positions(joint_positions_);
    std::fill_n(row, tree.freedoms(), 0.0);
    std::copy(joint_velocities_.begin(), joint_velocities_.end(), row + tree.freedoms());
  }
}

// Displacements are the cubics with the values and rates of the nodes, velocities follow the dense
// output of the method, as those of bodies do (group-record.h): as powers of the step's fraction.
void RodasSteps::append_joints(double time, GroupScratch& s) {
  const double h = time - work_.record.reached();
  for (std::size_t t = 0; t < work_.joints.size(); ++t) {
    TreeInGroup& tree = *system_.trees()[t];
    const std::size_t n = static_cast<std::size_t>(tree.freedoms()), row = system_.tree_row(t);
    const double *z1 = s.trial.data() + row, *u0 = s.state.data() + row + n, *u1 = z1 + n;
    const double *u3 = s.stage[4].data() + row + n, *u4 = s.stage[5].data() + row + n;
    std::vector<double> rate(n), powers(8 * n);
    multibody::chart_rate(tree.start().multibody->tree, {z1, n}, {u1, n}, rate);
    const auto set = [&](std::size_t e, double y0, double y1, double d3, double d4) {
      powers[e] = y0;
      powers[2 * n + e] = y1 - y0 + d3;
      powers[4 * n + e] = d4 - d3;
      powers[6 * n + e] = -d4;
    };
    for (std::size_t e = 0; e < n; ++e) {
      const double d3 = h * u0[e] - z1[e];
      set(e, 0, z1[e], d3, z1[e] - d3 - h * rate[e]);
      set(n + e, u0[e], u1[e], u3[e], u4[e]);
    }
    work_.joints[t].append(time, powers, tree.displaced(z1));
  }
}

// What a step would do that is over tolerance in the middle, where its error at the end is not.
bool RodasSteps::breaks_away(double h, int pressed_hard, GroupScratch& s) const {
  return (s.pressed_hard < pressed_hard && velocity_change(s) > answer::let_go_change) ||
         friction_doubt(s) > 1 || unforeseen(h, s) > 1;
}

// Linearises at the last node.
RodasSteps::Begun RodasSteps::begin(GroupScratch& s) {
  const double time = work_.reached(), left = start_.end - time;
  // outside bodies that do not move
  system_.set_outside(time, s);
  work_.record.load_last(system_, s.state.data());
  load_joints(s);
  s.firm = true;
  system_.linearise(time, s.state.data(), s, s.slope.data());
  ++counts_.evaluations;
  s.firm = s.reaches_firmness;
  const int pressed_hard = s.pressed_hard;
  const double turn_limit = answer::most_step_turn / std::max(fastest_turn(s), 1e-300);
  if (!(work_.next_step > 0)) work_.next_step = first_step(s);
  const double h = std::min({work_.next_step, left, turn_limit});
  if (system_.moved_from_outside())
    system_.set_time_slope(time, h, s.state.data(), s.slope.data(), s, s.time_slope.data());
  return {h, pressed_hard};
}

const char* RodasSteps::step() {
  GroupScratch& s = system_.scratch();
  const double time = work_.reached(), left = start_.end - time;
  auto [h, pressed_hard] = begin(s);
  Rejection last_one;
  for (bool rejected = false;; rejected = true) {
    // the last step lands on the end, the one before leaves no sliver; rounding decides neither
    // where steps are halves of what is left
    const bool last = h >= left * (1 - 1e-6);
    if (last)
      h = left;
    else if (2 * h > left * (1 + 1e-6))
      h = 0.5 * left;
    double error = 0;
    const bool good = try_step(h, s, error), fits = good && error <= 1;
    if (fits && s.reaches_firmness && !s.firm) {
      s.firm = true;
      ++counts_.rejected;
      continue;
    }
    const bool lets_go = fits && breaks_away(h, pressed_hard, s);
    if (fits && !lets_go) {
      const double change = std::clamp(answer::step_safety / std::sqrt(std::sqrt(error)),
                                       answer::least_step_change, answer::most_step_change);
      accept(last ? start_.end : time + h, s);
      ++counts_.steps;
      // a step cut short says little against a longer one
      const double planned = h * (rejected ? std::min(change, 1.0) : change);
      work_.next_step = !rejected && change >= answer::most_step_change
                            ? std::max(planned, work_.next_step)
                            : planned;
      return nullptr;
    }
    ++counts_.rejected;
    h *= lets_go ? answer::break_away_cut : good ? last_one.cut(h, error) : 0.1;
    if (!(time + 0.1 * h > time))
      return good ? "step size under the spacing of doubles" : "state not finite";
  }
}

}  // namespace

std::unique_ptr<StepMethod> rodas_steps(ArcWork& work) {
  return std::make_unique<RodasSteps>(work);
}

}  // namespace tw
