// Bodies, forces and right sides of contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/implicit/group-system.h"

#include <algorithm>
#include <cmath>

#include "integrate/implicit/group-rows.h"
#include "math/rotation-vector.h"

namespace tw {

using namespace rows;

namespace {

std::vector<std::pair<int, int>> member_pairs(const GroupStart& start) {
  std::vector<std::pair<int, int>> pairs;
  for (const GroupContact& c : start.contacts)
    if (c.a >= 0 && c.b >= 0 && c.a != c.b) pairs.emplace_back(c.a, c.b);
  for (const GroupBond& bond : start.bonds) pairs.emplace_back(bond.a, bond.b);
  return pairs;
}

// Rows of numbers are combined four at a time, and are as long as that needs (scratch).
constexpr std::size_t in_fours(std::size_t size) {
  return (size + lane_count - 1) / lane_count * lane_count;
}

}  // namespace

GroupSystem::GroupSystem(const GroupStart& start)
    : members_(static_cast<int>(start.members.size())),
      end_(start.end),
      outside_(start.outside),
      packs_(make_contact_packs(start)),
      matrix_(start.trees.empty() ? members_ : 0,
              start.trees.empty() ? member_pairs(start) : std::vector<std::pair<int, int>>()) {
  member_.reserve(start.members.size());
  for (const GroupMember& m : start.members) {
    Member& member = member_.emplace_back();
    member.mass = m.mass;
    member.inverse_mass = 1 / m.mass;
    member.inverse_moments = m.moments.cwiseInverse();
    member.force = m.force;
    member.torque = m.torque;
    member.forces = m.forces;
    forces_change_ = forces_change_ || (m.forces && m.forces->longest_unlooked() < never);
    member.q0 = m.q;
    member.is_link = m.tree >= 0;
  }
  for (const GroupBond& bond : start.bonds) bonds_.push_back({bond, {}});
  size_ = stretch_row(packs() + bends());
  for (const GroupTree& tree : start.trees) {
    trees_.push_back(std::make_unique<TreeInGroup>(tree, start.end));
    bases_move_ = bases_move_ || trees_.back()->moved_from_outside();
    tree_rows_.push_back(size_);
    size_ += index(2 * trees_.back()->freedoms());
  }
  if (!trees_.empty()) make_coupled();

  // what stands still is placed once
  std::vector<BodyKinematics> bodies(index(packs_.slots));
  for (int i = 0; i < static_cast<int>(outside_.size()); ++i) {
    const MotionBounds bounds = outside_[index(i)]->bounds(start.time, start.end);
    if (bounds.speed > 0 || bounds.turn > 0) moving_slots_.push_back(members_ + i);
    place_outside(members_ + i, start.time, bodies[index(members_ + i)]);
  }
  outside_at_start_.assign(bodies.begin() + members_, bodies.end());

  // the sides at the start
  for (int i = 0; i < members_; ++i) {
    const GroupMember& m = start.members[index(i)];
    set_member(i, m.x, m.q, m.v, m.L, bodies[index(i)]);
  }
  sides_.reserve(packs_.packs.size());
  for (const ContactPack& pack : packs_.packs) sides_.push_back(starting_side(pack, bodies.data()));
}

GroupScratch& GroupSystem::scratch() const {
  thread_local GroupScratch shared;
  const auto fit = [](auto& v, std::size_t size) {
    if (v.size() < size) v.resize(size);
  };
  const std::size_t row = in_fours(size_);
  const std::size_t slots = index(packs_.slots);
  fit(shared.members, index(members()));
  fit(shared.bodies, slots);
  fit(shared.changes, slots);
  fit(shared.wrenches, slots);
  fit(shared.linear, index(packs()));
  fit(shared.sides, index(packs()));
  // a multibody may have more links than freedoms
  fit(shared.right_side, std::max(unknowns(), index(members())));
  for (std::vector<double>* v : {&shared.state, &shared.slope, &shared.time_slope, &shared.trial})
    fit(*v, row);
  for (std::vector<double>& v : shared.stage) fit(v, row);
  return shared;
}

Vec3 GroupSystem::angular_velocity(int member, const Quat& q, const Vec3& L) const {
  const Mat3 R = q.toRotationMatrix();
  return R * member_[index(member)].inverse_moments.cwiseProduct(R.transpose() * L);
}

void GroupSystem::set_member(int member, const Vec3& x, const Quat& q, const Vec3& v, const Vec3& L,
                             BodyKinematics& out) const {
  const Mat3 R = q.toRotationMatrix();
  vec(out.x) = x;
  vec(out.v) = v;
  vec(out.w) = R * member_[index(member)].inverse_moments.cwiseProduct(R.transpose() * L);
  store_rotation(R, out.R);
}

PoseTwist GroupSystem::point_of(int member, const double* y, const BodyKinematics& body) const {
  const double* from = y + 12 * member;
  if (member_[index(member)].is_link) {
    const Mat3 R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(body.R);
    return {vec(body.x), Quat(R), vec(body.v), vec(body.w)};
  }
  return {vec(from), short_rotation(vec(from + 3)) * attitude(member), vec(from + 6), vec(body.w)};
}

void GroupSystem::set_outside(double time, GroupScratch& s) const {
  std::copy(outside_at_start_.begin(), outside_at_start_.end(), s.bodies.begin() + members_);
  s.moving_at = -never;
  set_moving(time, s);
}

void GroupSystem::set_outside_slot(int slot, double time, BodyKinematics& body) const {
  if (std::binary_search(moving_slots_.begin(), moving_slots_.end(), slot))
    place_outside(slot, time, body);
  else
    body = outside_at_start_[index(slot - members_)];
}

void GroupSystem::set_moving(double time, GroupScratch& s) const {
  if (s.moving_at == time) return;
  for (const int slot : moving_slots_) place_outside(slot, time, s.bodies[index(slot)]);
  s.moving_at = time;
}

void GroupSystem::place_outside(int slot, double time, BodyKinematics& body) const {
  // the arc ends before a corner at its end: velocities from the left there
  const double inside = time < end_ ? time : std::nextafter(end_, end_ - 1);
  const Trajectory& trajectory = *outside_[index(slot - members_)];
  PoseTwist there;
  if (inside == time) {
    there = trajectory.path_at(time);
  } else {
    const Pose pose = trajectory.pose(time);
    const Twist rates = trajectory.twist(inside);
    there = {pose.p, pose.q, rates.v, rates.w};
  }
  vec(body.x) = there.x;
  vec(body.v) = there.v;
  vec(body.w) = there.w;
  store_rotation(there.q.toRotationMatrix(), body.R);
}

// Springs and holds.
void GroupSystem::add_bond_wrenches(const double* y, GroupScratch& s) const {
  for (const HeldPair& pair : bonds_) {
    const auto& [a, b, bond] = pair.given;
    const Bond::Wrenches pull =
        bond->wrenches(point_of(a, y, s.bodies[index(a)]), point_of(b, y, s.bodies[index(b)]));
    vec(s.wrenches[index(a)].f) += pull.a.force;
    vec(s.wrenches[index(a)].t) += pull.a.torque;
    vec(s.wrenches[index(b)].f) += pull.b.force;
    vec(s.wrenches[index(b)].t) += pull.b.torque;
  }
}

template <bool with_derivative>
void GroupSystem::evaluate_as(double time, const double* y, GroupScratch& s, double* slope) const {
  // bodies
  set_moving(time, s);
  for (int i = 0; i < members_; ++i) {
    const double* from = y + 12 * i;
    double* to = slope + 12 * i;
    if (member_[index(i)].is_link) {
      std::fill_n(to, 12, 0.0);
      continue;
    }
    BodyKinematics& body = s.bodies[index(i)];
    const Vec3 theta = vec(from + 3);
    set_member(i, vec(from), short_rotation(theta) * member_[index(i)].q0, vec(from + 6),
               vec(from + 9), body);
    vec(to) = vec(from + 6);
    vec(to + 3) = rotation_vector_rate(theta, vec(body.w));
  }

  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const double* row = y + tree_rows_[t];
    trees_[t]->place(time, row, row + trees_[t]->freedoms(), s.bodies.data());
  }

  // contacts
  std::fill(s.wrenches.begin(), s.wrenches.begin() + packs_.slots, BodyWrench{});
  PackState state;
  const PackWish wish{.forces_alone = true, .without_firmness = !s.firm};
  s.reaches_firmness = false;
  s.pressed_hard = 0;
  for (int p = 0; p < packs(); ++p) {
    const ContactPack& pack = packs_.packs[index(p)];
    const std::size_t at = stretch_row(p);
    const LaneVec bend = pack.bend >= 0 ? load(y + bend_row(pack)) : LaneVec{};
    evaluate_pack(pack, s.bodies.data(), load(y + at), bend, sides_[index(p)], state, wish);
    s.reaches_firmness |= state.reaches_firmness;
    if (state.firm)
      for (int i = 0; i < lane_count; ++i)
        s.pressed_hard += state.firm_part[i] > 0 && state.N[i] > 0;
    if constexpr (with_derivative) linearise_pack(pack, state, s.linear[index(p)]);
    store(state.stretch_rate, slope + at);
    if (state.idle) continue;
    if (pack.bend >= 0) store(state.resistance.rate, slope + bend_row(pack));
    LaneVec on_a = cross(state.sa, state.f), on_b = cross(state.sb, state.f);
    if (state.turns) {
      on_a = on_a + state.torque;
      on_b = on_b + state.torque;
    }
    scatter(pack, state.f, on_a, on_b, s.wrenches.data());
  }

  add_bond_wrenches(y, s);

  // forces
  for (int i = 0; i < members_; ++i) {
    const Member& m = member_[index(i)];
    BodyWrench& wrench = s.wrenches[index(i)];
    if (m.forces) {
      const Wrench forced = m.forces->wrench(time, point_of(i, y, s.bodies[index(i)]));
      vec(wrench.f) += forced.force;
      vec(wrench.t) += forced.torque;
    }
    if (m.is_link) continue;
    vec(slope + 12 * i + 6) = m.inverse_mass * (m.force + vec(wrench.f));
    vec(slope + 12 * i + 9) = m.torque + vec(wrench.t);
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    TreeInGroup& tree = *trees_[t];
    const double *z = y + tree_rows_[t], *u = z + tree.freedoms();
    double *to = slope + tree_rows_[t], *u_rate = to + tree.freedoms();
    tree.evaluate(z, u, s.wrenches.data(), to, u_rate);
    if constexpr (with_derivative) tree.linearise(u, u_rate, s.wrenches.data());
  }
}

void GroupSystem::evaluate(double time, const double* y, GroupScratch& s, double* slope) const {
  evaluate_as<false>(time, y, s, slope);
}

template void GroupSystem::evaluate_as<true>(double, const double*, GroupScratch&, double*) const;

}  // namespace tw
