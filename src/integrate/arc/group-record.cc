// Dense output of contact groups.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/arc/group-record.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/constants.h"
#include "integrate/implicit/group-rows.h"
#include "integrate/turning.h"
#include "math/rotation-vector.h"

namespace tw {

using rows::load;
using rows::quat;
using rows::vec;

namespace {

constexpr int row_node = 12, row_step = 24, pack_side = 12;
// places in a member's part of a node and of a step
enum : int { x_at = 0, v_at = 3, L_at = 6, w_at = 9, q_at = 12, node_numbers = 16 };
enum : int { theta_at = 0, rate_at = 3, d3_at = 6, d4_at = 12, step_numbers = 18 };

// Puts numbers down one after the other, at the end of a row that grows by so many.
class Writer {
 public:
  template <class Row>
  Writer(Row& row, std::size_t count) {
    row.resize(row.size() + count);
    to_ = row.data() + row.size() - count;
  }
  void put(const double* from, int count) { to_ = std::copy_n(from, count, to_); }
  void put(const Vec3& v) { put(v.data(), 3); }
  void put(const Quat& q) {
    for (const double number : {q.w(), q.x(), q.y(), q.z()}) put(number);
  }
  void put(double number) { *to_++ = number; }

 private:
  double* to_;
};

Vec3 vec(Lanes v) { return {v[0], v[1], v[2]}; }
TW_LANES Lanes xyz(const double* p) { return Lanes{p[0], p[1], p[2], 0}; }

Quat normalized(const Quat& q) {
  const double n = 1 / std::sqrt(q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  return Quat(n * q.w(), n * q.x(), n * q.y(), n * q.z());
}

// x^2 + (y^2 + z^2), as Eigen's
TW_LANES double squared(Lanes v) {
  const Lanes s = v * v;
  return s[0] + (s[1] + s[2]);
}

void add(Aabb& box, Lanes lo, Lanes hi) {
  box.add(vec(lo));
  box.add(vec(hi));
}

}  // namespace

GroupRecord::GroupRecord(const GroupStart& start, const GroupSystem& system)
    : packs_(system.packs()), rows_(packs_ + system.bends()) {
  for (const GroupMember& m : start.members) {
    const int slot = m.tree < 0 ? count_++ : -1;
    if (!start.trees.empty()) slots_.push_back(slot);
  }
  for (const ContactPack& pack : system.contact_packs().packs)
    with_sides_ |= pack.feature != ContactFeature::plane;
  node_size_ = static_cast<std::size_t>(node_numbers * count_ + row_node * rows_);
  step_size_ = static_cast<std::size_t>(step_numbers * count_ + row_step * rows_ +
                                        (with_sides_ ? pack_side * packs_ : 0));
  first_sides_ = system.sides();
  // most arcs have one step
  nodes_.reserve(2 * node_size_);
  steps_.reserve(step_size_);
  times_.reserve(2);
  times_.push_back(start.time);
  Writer node(nodes_, node_size_);
  for (int i = 0; i < system.members(); ++i) {
    const GroupMember& m = start.members[static_cast<std::size_t>(i)];
    if (m.tree >= 0) continue;
    const Vec3 w = system.angular_velocity(i, m.q, m.L);
    for (const Vec3* part : {&m.x, &m.v, &m.L, &w}) node.put(*part);
    node.put(m.q);
  }
  const auto put_row = [&](const ContactPack& pack, Vec3 GroupContact::*field) {
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < lane_count; ++lane) {
        const int contact = pack.contact[lane];
        node.put(contact < 0 ? 0
                             : (start.contacts[static_cast<std::size_t>(contact)].*field)[axis]);
      }
  };
  for (const ContactPack& pack : system.contact_packs().packs)
    put_row(pack, &GroupContact::stretch);
  for (const ContactPack& pack : system.contact_packs().packs)
    if (pack.bend >= 0) put_row(pack, &GroupContact::bend);
}

GroupRecord GroupRecord::stretch_of(int member, double from) const {
  GroupRecord stretch;
  stretch.count_ = 1;
  stretch.node_size_ = node_numbers;
  stretch.step_size_ = step_numbers;
  // at a node the step before it, too: rates are those of the step that ends there
  const int first = steps() > 0 ? step_to(from) : 0;
  const auto count = static_cast<std::size_t>(steps() - first);
  stretch.times_.reserve(count + 1);
  stretch.nodes_.reserve(node_numbers * (count + 1));
  stretch.steps_.reserve(step_numbers * count);
  for (int i = first; i <= steps(); ++i) {
    stretch.times_.push_back(time(i));
    Writer(stretch.nodes_, node_numbers).put(slot_node(i, slot(member)), node_numbers);
    if (i < steps())
      Writer(stretch.steps_, step_numbers).put(slot_step(i, slot(member)), step_numbers);
    stretch.keep_bounds();
  }
  return stretch;
}

void GroupRecord::load_last(GroupSystem& system, double* y) const {
  const double* from = node(steps());
  for (int i = 0; i < system.members(); ++i, y += 12) {
    if (slot(i) < 0) {
      std::fill(y, y + 12, 0.0);
      continue;
    }
    std::copy(from + x_at, from + x_at + 3, y);
    std::fill(y + 3, y + 6, 0.0);
    std::copy(from + v_at, from + v_at + 6, y + 6);
    system.set_attitude(i, quat(from + q_at));
    from += node_numbers;
  }
  std::copy(from, from + row_node * rows_, y);
}

void GroupRecord::append(double time, const GroupSystem& system, const double* y1, const double* d3,
                         const double* d4) {
  times_.push_back(time);
  Writer node(nodes_, node_size_), step(steps_, step_size_);
  for (int i = 0; i < system.members(); ++i) {
    if (slot(i) < 0) continue;
    const double* y = y1 + 12 * i;
    const Vec3 theta = vec(y + 3);
    const Quat q = normalized(short_rotation(theta) * system.attitude(i));
    const Vec3 w = system.angular_velocity(i, q, vec(y + 9)), rate = rotation_vector_rate(theta, w);
    node.put(y, 3);
    node.put(y + 6, 6);
    node.put(w);
    node.put(q);
    step.put(theta);
    step.put(rate);
    step.put(d3 + 12 * i + 6, 6);
    step.put(d4 + 12 * i + 6, 6);
  }
  const int first = 12 * system.members();
  if (rows_ > 0) node.put(y1 + first, row_node * rows_);
  for (int p = 0; p < rows_; ++p) {
    step.put(d3 + first + 12 * p, 12);
    step.put(d4 + first + 12 * p, 12);
  }
  if (with_sides_)
    for (const LaneVec& side : system.sides()) {
      double numbers[pack_side];
      std::memcpy(numbers, &side, sizeof side);
      step.put(numbers, pack_side);
    }
  keep_bounds();
}

void GroupRecord::keep_bounds() {
  constexpr int block = BoundsTree::block;
  if (steps() == 0 || steps() % block != 0) return;
  kept_bounds_.resize(static_cast<std::size_t>(count_));
  for (int slot = 0; slot < count_; ++slot) {
    BoundsTree& kept = kept_bounds_[static_cast<std::size_t>(slot)];
    const int first = block * static_cast<int>(kept.size());
    MotionBounds sum;
    for (int i = first; i < first + block; ++i) add_step_bounds(i, slot, time(i), time(i + 1), sum);
    kept.append(sum);
  }
}

int GroupRecord::step_from(double time) const {
  if (!(time < reached())) return -1;
  const auto next = std::upper_bound(times_.begin(), times_.end(), time);
  return std::max(0, static_cast<int>(next - times_.begin()) - 1);
}

int GroupRecord::step_to(double time) const {
  const auto end = std::lower_bound(times_.begin(), times_.end(), time);
  return std::clamp(static_cast<int>(end - times_.begin()) - 1, 0, steps() - 1);
}

double GroupRecord::fraction(int i, double t) const {
  return std::clamp((t - time(i)) / length(i), 0.0, 1.0);
}

const double* GroupRecord::slot_node(int i, int slot) const {
  return node(i) + node_numbers * slot;
}

const double* GroupRecord::slot_step(int i, int slot) const {
  return step(i) + step_numbers * slot;
}

// rate(0) = y1 - y0 + D3, rate(1) = y1 - y0 - D3 - D4
GroupRecord::Cubic GroupRecord::path(int i, int slot) const {
  const double *a = slot_node(i, slot), *b = slot_node(i + 1, slot);
  const Lanes y0 = xyz(a + x_at), y1 = xyz(b + x_at), h = lanes(length(i));
  const Lanes d3 = h * xyz(a + v_at) - (y1 - y0);
  return {y0, y1, d3, (y1 - y0) - d3 - h * xyz(b + v_at)};
}

GroupRecord::Cubic GroupRecord::rotation(int i, int slot) const {
  const double *a = slot_node(i, slot), *s = slot_step(i, slot);
  const Lanes y1 = xyz(s + theta_at), h = lanes(length(i));
  const Lanes d3 = h * xyz(a + w_at) - y1;
  return {lanes(0), y1, d3, y1 - d3 - h * xyz(s + rate_at)};
}

GroupRecord::Place GroupRecord::place(double t) const {
  const int i = step_from(t);
  return i < 0 ? Place{steps(), 0} : Place{i, fraction(i, t)};
}

Vec3 GroupRecord::position_of(int slot, Place at) const {
  const auto [i, r] = at;
  return r > 0 ? vec(path(i, slot).value(r)) : vec(slot_node(i, slot) + x_at);
}

Quat GroupRecord::attitude_of(int slot, Place at) const {
  const auto [i, r] = at;
  const Quat begin = quat(slot_node(i, slot) + q_at);
  return r > 0 ? Quat(short_rotation(vec(rotation(i, slot).value(r))) * begin) : begin;
}

void GroupRecord::velocities_of(int slot, Place at, Vec3& v, Vec3& L) const {
  const auto [i, r] = at;
  const double* a = slot_node(i, slot);
  v = vec(a + v_at);
  L = vec(a + L_at);
  if (!(r > 0)) return;
  const double *b = slot_node(i + 1, slot), *s = slot_step(i, slot);
  const auto along = [&](int value_at, int change) {
    const Cubic cubic{xyz(a + value_at), xyz(b + value_at), xyz(s + d3_at + change),
                      xyz(s + d4_at + change)};
    return vec(cubic.value(r));
  };
  v = along(v_at, 0);
  L = along(L_at, 3);
}

LaneVec GroupRecord::row(int number, double t) const {
  const auto [i, r] = place(t);
  const int at = node_numbers * count_ + row_node * number;
  if (!(r > 0)) return load(node(i) + at);
  const double* d = step(i) + step_numbers * count_ + row_step * number;
  const LaneVec y0 = load(node(i) + at), y1 = load(node(i + 1) + at), d3 = load(d),
                d4 = load(d + 12);
  return lanes(1 - r) * y0 + lanes(r) * (y1 + lanes(1 - r) * (d3 + lanes(r) * d4));
}

LaneVec GroupRecord::side(int pack, double t) const {
  if (!with_sides_ || steps() == 0) return first_sides_[static_cast<std::size_t>(pack)];
  return load(step(step_to(t)) + step_numbers * count_ + row_step * rows_ + pack_side * pack);
}

void GroupRecord::pose_rates(int member, double t, Vec3& dx, Vec3& w) const {
  const int i = step_to(t), at = slot(member);
  const double r = fraction(i, t), rate = 1 / length(i);
  const Cubic turn = rotation(i, at);
  dx = vec(lanes(rate) * path(i, at).rate(r));
  w = angular_velocity(vec(turn.value(r)), vec(lanes(rate) * turn.rate(r)));
}

PoseTwist GroupRecord::path_at(int member, double t) const {
  const auto [i, r] = place(t);
  if (!(r > 0)) {
    // at a node: the rates are those of the step that ends there
    const Pose there = pose(member, t);
    const Twist rates = this->rates(member, t);
    return {there.p, there.q, rates.v, rates.w};
  }
  const Cubic way = path(i, slot(member)), turn = rotation(i, slot(member));
  const Lanes rate = lanes(1 / length(i));
  const Vec3 theta = vec(turn.value(r));
  return {vec(way.value(r)), short_rotation(theta) * quat(slot_node(i, slot(member)) + q_at),
          vec(rate * way.rate(r)), angular_velocity(theta, vec(rate * turn.rate(r)))};
}

void GroupRecord::add_step_bounds(int i, int slot, double from, double to,
                                  MotionBounds& bounds) const {
  const double r0 = fraction(i, from), r1 = fraction(i, to), rate = 1 / length(i);

  // path: control points over [r0, r1]: p(r0), p + (r1-r0) p'/3 from either end, p(r1)
  const Cubic way = path(i, slot);
  const Lanes p0 = way.value(r0), p1 = way.value(r1), u0 = way.rate(r0), u1 = way.rate(r1);
  const Lanes third = lanes((r1 - r0) / 3), half = lanes(0.5 * (r1 - r0));
  const Lanes control0 = p0 + third * u0, control1 = p1 - third * u1;
  add(bounds.path, min(min(p0, p1), min(control0, control1)),
      max(max(p0, p1), max(control0, control1)));

  // x' is quadratic: within its control points
  const Lanes s0 = way.second(r0), s1 = way.second(r1), u = u0 + half * s0;
  const double fastest = std::max({squared(u0), squared(u), squared(u1)});
  bounds.speed = std::max(bounds.speed, rate * std::sqrt(fastest));

  // x'' is linear: largest at an end
  const Lanes by_time = lanes(rate * rate);
  add(bounds.acceleration, min(by_time * s0, by_time * s1), max(by_time * s0, by_time * s1));

  // |w| <= |theta'|, quadratic: within its control points; |Jl| <= 1
  const Cubic turn = rotation(i, slot);
  const Lanes t0 = turn.rate(r0), t1 = turn.rate(r1), middle = t0 + half * turn.second(r0);
  const double speed = rate * std::sqrt(std::max({squared(t0), squared(t1), squared(middle)}));
  bounds.turn = std::max(bounds.turn, speed);

  // |w'| <= |theta''| + |theta'| |theta x theta'|/6, and theta x theta' = r^2 e x (-D3 +
  // (1-2r) D4)/h with e = theta/r = theta1 + (1-r)(D3 + r D4)
  const double swing = std::sqrt(squared(turn.d3)) + std::sqrt(squared(turn.d4));
  const double bend = r1 * r1 * rate * (std::sqrt(squared(turn.y1)) + swing) * swing;
  const double turn_second =
      rate * rate * std::sqrt(std::max(squared(turn.second(r0)), squared(turn.second(r1))));
  bounds.turn_change = std::max(bounds.turn_change, turn_second + speed * bend / 6);
}

MotionBounds GroupRecord::bounds(int member, double from, double to) const {
  MotionBounds result;
  // steps of positive overlap, at least one
  const int last = step_to(to), first = std::min(std::max(step_from(from), 0), last);
  // of whole blocks between the first and the last one
  constexpr int block = BoundsTree::block;
  const int first_block = first / block + 1, last_block = last / block;
  const bool has_blocks = from < to && first_block < last_block;
  if (has_blocks)
    kept_bounds_[static_cast<std::size_t>(slot(member))].add(
        static_cast<std::size_t>(first_block), static_cast<std::size_t>(last_block), result);
  for (int i = from < to ? first : last; i <= last; ++i) {
    if (has_blocks && i == first_block * block) i = last_block * block;
    add_step_bounds(i, slot(member), from, to, result);
  }
  // rounding of the interpolant
  const double largest =
      std::max(result.path.lo.cwiseAbs().maxCoeff(), result.path.hi.cwiseAbs().maxCoeff());
  result.path.grow(1e-15 * largest);
  const double widen = 1 + 1e-12;
  result.acceleration.grow(1e-12 * std::max(result.acceleration.lo.cwiseAbs().maxCoeff(),
                                            result.acceleration.hi.cwiseAbs().maxCoeff()));
  result.speed *= widen;
  result.turn *= widen;
  result.turn_change *= widen;
  return result;
}

double GroupRecord::turn_change_across(const Vec3& n, int member, double from, double to) const {
  const int last = step_to(to), first = std::min(std::max(step_from(from), 0), last);
  if (last - first >= cost::turning_steps) return never;
  double most = 0;
  for (int i = first; i <= last; ++i) {
    // the control points of theta and of its rates over [r0, r1]
    const double r0 = fraction(i, std::max(from, time(i))),
                 r1 = fraction(i, std::min(to, time(i + 1))), rate = 1 / length(i), h = r1 - r0;
    const Cubic turn = rotation(i, slot(member));
    const Vec3 p0 = vec(turn.value(r0)), p1 = vec(turn.value(r1)), u0 = vec(turn.rate(r0)),
               u1 = vec(turn.rate(r1)), s0 = vec(turn.second(r0)), s1 = vec(turn.second(r1));
    const Vec3 theta[] = {p0, p0 + h / 3 * u0, p1 - h / 3 * u1, p1};
    const Vec3 rates[] = {rate * u0, rate * (u0 + 0.5 * h * s0), rate * u1};
    const Vec3 seconds[] = {rate * rate * s0, rate * rate * s1};
    most = std::max(most, tw::turn_change_across(n, theta, rates, seconds));
  }
  return most;
}

}  // namespace tw
