// The derivative of a contact group and the linear systems of its stages.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "integrate/implicit/group-rows.h"
#include "integrate/implicit/group-system.h"

namespace tw {

using namespace rows;

namespace {

// Of a first derivative, forwards, to the fourth order: the arc may begin at a corner of what
// moves.
constexpr double forward_weights[] = {-25.0 / 12, 4, -3, 4.0 / 3, -0.25};

}  // namespace

void GroupSystem::linearise(double time, const double* y, GroupScratch& s, double* slope) {
  evaluate_as<true>(time, y, s, slope);
  for (int p = 0; p < packs(); ++p)
    if (packs_.packs[index(p)].feature != ContactFeature::plane)
      sides_[index(p)] = s.linear[index(p)].n;
  for (int i = 0; i < members_; ++i) {
    const Member& member = member_[index(i)];
    MemberLinear& m = s.members[index(i)];
    if (member.forces) {
      m.point = point_of(i, y, s.bodies[index(i)]);
      m.forced = member.forces->derivative(time, m.point);
    }
    if (member.is_link) continue;
    const Mat3 R =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(s.bodies[index(i)].R);
    m.w = vec(s.bodies[index(i)].w);
    m.J = R * member.inverse_moments.asDiagonal() * R.transpose();
    m.W = m.J * cross_matrix(vec(y + 12 * i + 9)) - cross_matrix(m.w);
  }
  for (HeldPair& pair : bonds_) {
    const auto& [a, b, bond] = pair.given;
    pair.derivative =
        bond->derivative(point_of(a, y, s.bodies[index(a)]), point_of(b, y, s.bodies[index(b)]));
  }
}

void GroupSystem::difference_slopes(double time, double step, const double* y, const double* slope,
                                    GroupScratch& s, double* time_slope) const {
  const double d = step / 32;
  thread_local std::vector<double> later;
  later.resize(size_);
  for (std::size_t e = 0; e < size_; ++e) time_slope[e] = forward_weights[0] / d * slope[e];
  for (int j = 1; j < 5; ++j) {
    evaluate(time + j * d, y, s, later.data());
    for (std::size_t e = 0; e < size_; ++e) time_slope[e] += forward_weights[j] / d * later[e];
  }
}

void GroupSystem::set_time_slope(double time, double step, const double* y, const double* slope,
                                 GroupScratch& s, double* time_slope) const {
  if (bases_move_) return difference_slopes(time, step, y, slope, s, time_slope);
  std::fill(time_slope, time_slope + size_, 0.0);
  std::fill(s.changes.begin(), s.changes.begin() + packs_.slots, BodyChange{});
  std::fill(s.wrenches.begin(), s.wrenches.begin() + packs_.slots, BodyWrench{});

  // outside bodies move by their velocities; accelerations (-3 u0 + 4 u1 - u2)/(2 d)
  const double d = step / 32;
  for (const int slot : moving_slots_) {
    BodyChange& change = s.changes[index(slot)];
    Twist u[3];
    for (int j = 0; j < 3; ++j) u[j] = outside_[index(slot - members_)]->twist(time + j * d);
    vec(change.x) = u[0].v;
    vec(change.th) = u[0].w;
    vec(change.v) = (4 * (u[1].v - u[0].v) - (u[2].v - u[0].v)) / (2 * d);
    vec(change.w) = (4 * (u[1].w - u[0].w) - (u[2].w - u[0].w)) / (2 * d);
  }

  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    const PackLinear& linear = s.linear[index(p)];
    if (linear.idle) continue;
    PackChange change;
    change_pack(pack, linear, s.changes.data(), {}, true, change);
    scatter_change(pack, linear, change, s.wrenches.data());
    store(transposed_times(linear.Ra, -(linear.inverse_ct * change.stretching)),
          time_slope + stretch_row(p));
    if (pack.bend >= 0)
      store(transposed_times(linear.Ra, -(linear.resistance.inverse_c * change.bending)),
            time_slope + bend_row(pack));
  }
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    if (!m.forces || !(m.forces->longest_unlooked() < never)) continue;
    BodyWrench& wrench = s.wrenches[index(i)];
    for (int j = 0; j < 5; ++j) {
      const Wrench f = m.forces->wrench(time + j * d, s.members[index(i)].point);
      vec(wrench.f) += forward_weights[j] / d * f.force;
      vec(wrench.t) += forward_weights[j] / d * f.torque;
    }
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    double* row = time_slope + tree_rows_[t] + trees_[t]->freedoms();
    trees_[t]->gather(s.wrenches.data(), row);
    trees_[t]->accelerate(row);
  }
  for (int i = 0; i < members_; ++i) {
    if (member_[index(i)].is_link) continue;
    vec(time_slope + 12 * i + 6) = member_[index(i)].inverse_mass * vec(s.wrenches[index(i)].f);
    vec(time_slope + 12 * i + 9) = vec(s.wrenches[index(i)].t);
  }
}

LaneBody GroupSystem::gather(const ContactPack& pack, const int (&slot)[lane_count],
                             const GroupScratch& s) const {
  LaneBody out = {};
  if (pack.uniform) {
    if (slot[0] >= members_) return out;
    const MemberLinear& m = s.members[index(slot[0])];
    for (int r = 0; r < 3; ++r) {
      out.P.row[r] = {lanes(m.P(r, 0)), lanes(m.P(r, 1)), lanes(m.P(r, 2))};
      out.V.row[r] = {lanes(m.V(r, 0)), lanes(m.V(r, 1)), lanes(m.V(r, 2))};
    }
    return out;
  }
  for (int lane = 0; lane < lane_count; ++lane) {
    if (slot[lane] >= members_) continue;
    const MemberLinear& m = s.members[index(slot[lane])];
    for (int r = 0; r < 3; ++r) {
      set_lane(out.P.row[r], lane, m.P.row(r));
      set_lane(out.V.row[r], lane, m.V.row(r));
    }
  }
  return out;
}

template <class Number>
void GroupSystem::add_block(int Y, int X, const LaneMat (&part)[2][2], Number number) {
  double* to = matrix_.at(matrix_.offset(Y, X));
  constexpr int stride = BodyMatrix::block;
  for (int i = 0; i < 2; ++i)
    for (int r = 0; r < 3; ++r) {
      double* row = to + 3 * i + r;
      for (int j = 0; j < 2; ++j, row += 3 * stride) {
        row[0] -= number(part[i][j].row[r].x);
        row[stride] -= number(part[i][j].row[r].y);
        row[2 * stride] -= number(part[i][j].row[r].z);
      }
    }
}

double GroupSystem::squared_frequency(GroupScratch& s) const {
  double* total = s.right_side.data();
  std::fill(total, total + members_, 0.0);
  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    // whether what just touches presses already is rounding
    const PackLinear& linear = s.linear[index(p)];
    const Lanes slope = linear.idle ? pack.k : max(pack.k, sqrt(dot(linear.g, linear.g)));
    for (int i = 0; i < pack.count; ++i)
      for (const int body : {pack.a[i], pack.b[i]})
        if (body < members_) total[body] += slope[i];
  }
  for (const HeldPair& pair : bonds_)
    for (const int body : {pair.given.a, pair.given.b}) {
      const Bond& bond = *pair.given.bond;
      const Member& m = member_[index(body)];
      const double turning = bond.turn.stiffness * m.mass * m.inverse_moments.maxCoeff();
      total[body] += std::max(bond.spring.stiffness, bond.holds ? turning : 0.0);
    }
  double largest = 0;
  for (int i = 0; i < members_; ++i)
    largest = std::max(largest, total[i] * member_[index(i)].inverse_mass);
  return largest;
}

// |dF/d.|/m + |dT/d.|/I
double GroupSystem::rate_of(int member, const Mat6& derivative) const {
  const Member& m = member_[index(member)];
  return derivative.topLeftCorner<3, 3>().norm() * m.inverse_mass +
         derivative.bottomRightCorner<3, 3>().norm() * m.inverse_moments.maxCoeff();
}

double GroupSystem::squared_frequency_of(int bond) const {
  const HeldPair& pair = bonds_[index(bond)];
  return rate_of(pair.given.a, pair.derivative.of[0][0].by_pose) +
         rate_of(pair.given.b, pair.derivative.of[1][1].by_pose);
}

GroupSystem::SpringRates GroupSystem::spring_rates(const GroupScratch& s) const {
  std::vector<SpringRates> total(index(members_));
  const auto add = [&](int member, const WrenchDerivative& by) {
    total[index(member)].squared_frequency += rate_of(member, by.by_pose);
    total[index(member)].damping += rate_of(member, by.by_twist);
  };
  for (const HeldPair& pair : bonds_) {
    add(pair.given.a, pair.derivative.of[0][0]);
    add(pair.given.b, pair.derivative.of[1][1]);
  }
  SpringRates largest;
  for (int i = 0; i < members_; ++i) {
    if (member_[index(i)].forces) add(i, s.members[index(i)].forced);
    const SpringRates& of = total[index(i)];
    largest.squared_frequency = std::max(largest.squared_frequency, of.squared_frequency);
    largest.damping = std::max(largest.damping, of.damping);
  }
  return largest;
}

bool GroupSystem::factor(double sigma, GroupScratch& s) {
  sigma_ = sigma;
  if (coupled_) return factor_coupled(s);
  matrix_.clear(s.matrix);
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    MemberLinear& linear = s.members[index(i)];
    linear.set_stage_rate(sigma);
    double* block = matrix_.at(matrix_.offset(i, i));
    for (int r = 0; r < 6; ++r) block[r * BodyMatrix::block + r] = (r < 3 ? m.mass : 1.0) * sigma;
    if (m.forces) subtract_from_block(linear.forced, linear, i, i);
  }
  for (const HeldPair& pair : bonds_) {
    const int body[2] = {pair.given.a, pair.given.b};
    for (const int Y : {0, 1})
      for (const int X : {0, 1})
        subtract_from_block(pair.derivative.of[Y][X], s.members[index(body[X])], body[Y], body[X]);
  }
  PackBlocks blocks;
  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    PackLinear& linear = s.linear[index(p)];
    if (linear.idle) continue;
    set_stage_rate(pack, sigma, linear);
    pack_blocks(pack, linear, sigma, gather(pack, pack.a, s), gather(pack, pack.b, s), blocks);
    const auto add_lane = [&](int lane, auto number) {
      const int body[2] = {pack.a[lane], pack.b[lane]};
      for (int Y = 0; Y < 2; ++Y)
        for (int X = 0; X < 2; ++X)
          if (body[Y] < members_ && body[X] < members_)
            add_block(body[Y], body[X], blocks.part[Y][X], number);
    };
    // the lanes of one pair as one
    if (pack.uniform) {
      add_lane(0, [](const Lanes& v) { return sum(v); });
    } else {
      for (int lane = 0; lane < pack.count; ++lane)
        add_lane(lane, [lane](const Lanes& v) { return v[lane]; });
    }
  }
  return matrix_.factor();
}

// What the wrench on Y changes by with the stage of X: d(x) = kv/s, d(theta) = P kL, dw = V kL.
void GroupSystem::subtract_from_block(const WrenchDerivative& by, const MemberLinear& m, int Y,
                                      int X) {
  Eigen::Map<Mat6> block(matrix_.at(matrix_.offset(Y, X)));
  block.leftCols<3>() -= by.by_pose.leftCols<3>() / sigma_ + by.by_twist.leftCols<3>();
  block.rightCols<3>() -= by.by_pose.rightCols<3>() * m.P + by.by_twist.rightCols<3>() * m.V;
}

// The wrenches of a spring or hold by the changes of its two bodies.
void GroupSystem::change_bond(int number, GroupScratch& s) const {
  const HeldPair& pair = bonds_[index(number)];
  const int body[2] = {pair.given.a, pair.given.b};
  for (const int Y : {0, 1}) {
    Vec6 sum = Vec6::Zero();
    for (const int X : {0, 1})
      sum += change_of(pair.derivative.of[Y][X], s.changes[index(body[X])]);
    BodyWrench& wrench = s.wrenches[index(body[Y])];
    vec(wrench.f) += sum.head<3>();
    vec(wrench.t) += sum.tail<3>();
  }
}

// The right sides of the stretches and the bends of a pack.
PackSides GroupSystem::sides_of(int p, const PackLinear& linear, const double* stage) const {
  const ContactPack& pack = packs_.packs[index(p)];
  PackSides sides;
  sides.stretch = linear.Ra * load(stage + stretch_row(p));
  if (pack.bend >= 0) sides.bend = linear.Ra * load(stage + bend_row(pack));
  return sides;
}

// The wrenches of all contacts by the changes of the slots and the right sides of the stretches.
void GroupSystem::scatter_stretches(GroupScratch& s, const double* stage) const {
  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    const PackLinear& linear = s.linear[index(p)];
    if (linear.idle) continue;
    PackChange change;
    PackSides& sides = s.sides[index(p)];
    sides = sides_of(p, linear, stage);
    change_pack(pack, linear, s.changes.data(), sides, false, change);
    scatter_change(pack, linear, change, s.wrenches.data());
  }
}

// The stretches of anchored friction and the bends, once all changes of the slots are known; the
// right sides are those that scatter_stretches() found.
void GroupSystem::solve_stretches(GroupScratch& s, double* stage) const {
  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    const bool anchored = pack.law == FrictionLaw::anchored, bends = pack.bend >= 0;
    if (!anchored && !bends) continue;
    const PackLinear& linear = s.linear[index(p)];
    if (linear.idle) {
      // z' = -kt z/ct, in any frame
      double* row = stage + stretch_row(p);
      if (anchored) store(lanes(1) / (lanes(sigma_) + pack.kt / pack.ct) * load(row), row);
      continue;
    }
    const PackSides& sides = s.sides[index(p)];
    PackChange change;
    change_stretches(pack, linear, s.changes.data(), change);
    if (anchored)
      store(transposed_times(linear.Ra, solve_stretch(linear, sides.stretch, change.stretching)),
            stage + stretch_row(p));
    if (bends)
      store(transposed_times(linear.Ra, solve_bend(linear.resistance, sides.bend, change.bending)),
            stage + bend_row(pack));
  }
}

bool GroupSystem::solve(GroupScratch& s, double* stage) {
  if (coupled_) return solve_coupled(s, stage);
  std::fill(s.changes.begin() + members_, s.changes.begin() + packs_.slots, BodyChange{});
  std::fill(s.wrenches.begin(), s.wrenches.begin() + packs_.slots, BodyWrench{});

  // positions of the eliminated part
  for (int i = 0; i < members_; ++i)
    s.members[index(i)].eliminate(stage + 12 * i, s.changes[index(i)]);

  // right side
  scatter_stretches(s, stage);
  for (int i = 0; i < static_cast<int>(bonds_.size()); ++i) change_bond(i, s);
  double* right = s.right_side.data();
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    const double* r = stage + 12 * i;
    vec(right + 6 * i) = m.mass * vec(r + 6) + vec(s.wrenches[index(i)].f);
    vec(right + 6 * i + 3) = vec(r + 9) + vec(s.wrenches[index(i)].t);
    if (m.forces)
      Eigen::Map<Vec6>(right + 6 * i) += change_of(s.members[index(i)].forced, s.changes[index(i)]);
  }
  if (!matrix_.solve(right)) return false;

  // all unknowns
  for (int i = 0; i < members_; ++i)
    s.members[index(i)].take(right + 6 * i, s.changes[index(i)], stage + 12 * i);
  solve_stretches(s, stage);
  return true;
}

}  // namespace tw
