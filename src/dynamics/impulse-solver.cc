// The worst approacher first.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impulse-solver.h"

#include <algorithm>

#include "dynamics/stronge-law.h"

namespace tw {

ImpulseSlot ImpulseSlot::of(const Body& body, const PoseTwist& point) {
  ImpulseSlot slot{point.x, point.v, point.w};
  if (!body.dynamic()) return slot;
  slot.inverse_mass = 1 / body.mass;
  slot.inverse_inertia = inverse_inertia_world(body, point.q);
  slot.answer = Answer::free;
  return slot;
}

ImpulseSlot ImpulseSlot::border(const PoseTwist& point) {
  ImpulseSlot slot{point.x, point.v, point.w};
  slot.answer = Answer::border;
  return slot;
}

void ImpulseSolver::clear() {
  slots_.clear();
  blocks_.clear();
  holds_.clear();
  received_.clear();
  normal_impulse_ = work_of_held_ = largest_impulse_ = largest_approach_ = 0;
  largest_ = {};
}

std::uint32_t ImpulseSolver::add(const ImpulseSlot& slot) {
  slots_.push_back(slot);
  return static_cast<std::uint32_t>(slots_.size() - 1);
}

void ImpulseSolver::join(std::uint32_t of, std::uint32_t on, const Mat6& block) {
  slots_[of].answer = slots_[on].answer = Answer::joined;
  blocks_.resize(slots_.size());
  blocks_[on].push_back({of, block});
  received_.resize(slots_.size(), Vec6::Zero());
}

std::vector<std::uint32_t> ImpulseSolver::answering(std::uint32_t slot) const {
  if (slots_[slot].answer == Answer::free) return {slot};
  std::vector<std::uint32_t> all;
  if (slots_[slot].answer == Answer::joined)
    for (const Block& block : blocks_[slot]) all.push_back(block.of);
  return all;
}

void ImpulseSolver::return_to(const Moment& moment) {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].v = moment.slots[i].v;
    slots_[i].w = moment.slots[i].w;
  }
  std::copy(moment.received.begin(), moment.received.end(), received_.begin());
  std::fill(received_.begin() + static_cast<std::ptrdiff_t>(moment.received.size()),
            received_.end(), Vec6::Zero());
  normal_impulse_ = moment.normal_impulse;
  work_of_held_ = moment.work_of_held;
}

// K_ij at one point of both
Mat3 ImpulseSolver::cross_compliance(std::uint32_t of, std::uint32_t on, const Vec3& where) const {
  Mat3 K = Mat3::Zero();
  for (const Block& block : blocks_[on]) {
    if (block.of != of) continue;
    Eigen::Matrix<double, 6, 3> wrench;
    wrench << Mat3::Identity(), cross_matrix(where - slots_[on].x);
    Eigen::Matrix<double, 3, 6> velocity;
    velocity << Mat3::Identity(), -cross_matrix(where - slots_[of].x);
    K += velocity * block.Y * wrench;
  }
  return K;
}

Mat3 ImpulseSolver::compliance(std::uint32_t slot, const Vec3& where) const {
  const ImpulseSlot& s = slots_[slot];
  if (s.answer == Answer::joined) return cross_compliance(slot, slot, where);
  if (s.answer != Answer::free) return Mat3::Zero();
  return contact_compliance(s.inverse_mass, s.inverse_inertia, where - s.x);
}

Mat3 ImpulseSolver::compliance(const ImpulseContact& c) const {
  Mat3 K = compliance(c.a, c.point) + compliance(c.b, c.point);
  if (slots_[c.a].answer == Answer::joined && slots_[c.b].answer == Answer::joined)
    K -= cross_compliance(c.a, c.b, c.point) + cross_compliance(c.b, c.a, c.point);
  return K;
}

void ImpulseSolver::apply(std::uint32_t slot, const Vec3& impulse, const Vec3& where) {
  ImpulseSlot& s = slots_[slot];
  if (s.answer == Answer::free) {
    s.v += s.inverse_mass * impulse;
    s.w += s.inverse_inertia * (where - s.x).cross(impulse);
  }
  if (s.answer != Answer::joined) return;
  Vec6 wrench;
  wrench << impulse, (where - s.x).cross(impulse);
  received_[slot] += wrench;
  for (const Block& block : blocks_[slot]) {
    const Vec6 change = block.Y * wrench;
    slots_[block.of].v += change.head<3>();
    slots_[block.of].w += change.tail<3>();
  }
}

void ImpulseSolver::strike(const ImpulseContact& c) {
  const Vec3 u = relative_velocity(c);
  const auto law = c.law == ImpactLaw::stronge ? stronge_impulse : impact_impulse;
  exchange(c, law(compliance(c), c.normal, u, c.restitution, c.friction));
}

void ImpulseSolver::exchange(const ImpulseContact& c, const Vec3& impulse) {
  const ImpulseSlot& a = slots_[c.a];
  const ImpulseSlot& b = slots_[c.b];
  if (!a.moves()) work_of_held_ += impulse.dot(a.velocity_at(c.point));
  if (!b.moves()) work_of_held_ -= impulse.dot(b.velocity_at(c.point));
  const double along = impulse.dot(c.normal);
  if (along > largest_impulse_) {
    largest_impulse_ = along;
    largest_approach_ = -approach(c);
    largest_ = c;
  }
  normal_impulse_ += along;
  apply(c.a, -impulse, c.point);
  apply(c.b, impulse, c.point);
}

ImpulseSolver::Excess ImpulseSolver::worst(std::span<const ImpulseContact> contacts,
                                           double negligible) const {
  Excess worst{nullptr, negligible};
  for (const ImpulseContact& c : contacts)
    if (const double excess = -approach(c) - c.bears; excess > worst.speed) worst = {&c, excess};
  return worst;
}

ImpulseResult ImpulseSolver::solve(std::span<const ImpulseContact> contacts, double negligible,
                                   int most_impulses) {
  ImpulseResult result;
  for (;;) {
    const Excess next = worst(contacts, negligible);
    if (!next.contact) return result;
    if (result.impulses == most_impulses) {
      result.left_over = next.speed;
      return result;
    }
    const ImpulseContact& c = *next.contact;
    if (reaches_border(c)) {
      result.stopped_at = &c;
      return result;
    }
    strike(c);
    ++result.impulses;
  }
}

}  // namespace tw
