// The 64-bit words that a field consists of, in a fixed order: for hashes and comparisons.
//
// each_word(value, put) calls put(std::uint64_t) or put(double) for each.  No addresses: equal
// values give equal words in every run.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <concepts>
#include <cstdint>
#include <exception>
#include <memory>
#include <type_traits>
#include <vector>

#include "dynamics/forces.h"
#include "dynamics/ids.h"
#include "math/vec.h"
#include "timeline/collision.h"
#include "timeline/key.h"
#include "timeline/state.h"

namespace tw {

template <class Put>
void each_word(double value, Put&& put) {
  put(value);
}
template <class T, class Put>
requires std::integral<T> || std::is_enum_v<T>
void each_word(T value, Put&& put) { put(static_cast<std::uint64_t>(value)); }
template <class Put>
void each_word(const Vec3& v, Put&& put) {
  for (int i = 0; i < 3; ++i) put(v[i]);
}
template <class Put>
void each_word(const Quat& q, Put&& put) {
  for (int i = 0; i < 4; ++i) put(q.coeffs()[i]);
}
template <class Put>
void each_word(const Key& key, Put&& put) {
  put(key.time);
  put(std::uint64_t{key.microstep});
  put(kind_code(key.kind));
  put(key.id);
}
template <class Put>
void each_word(const SlotsPtr& slots, Put&& put) {
  if (slots) put(slots->hash());
}
template <class Put>
void each_word(const ForcesPtr& forces, Put&& put) {
  if (forces) put(forces->hash());
}
template <class Put>
void each_word(const std::exception_ptr& error, Put&& put) {
  put(std::uint64_t{error != nullptr});
}
template <class Put>
void each_word(const ImpactRun& run, Put&& put) {
  put(std::uint64_t{run.count});
  put(std::uint64_t{run.wall});
  put(std::uint64_t{run.strikes});
  put(run.wall_time);
  put(run.wall_speed);
  put(run.last_time);
  put(std::uint64_t{run.partner});
}
template <class Put>
void each_word(const Tally& tally, Put&& put) {
  put(std::uint64_t{tally.fusions});
  put(std::uint64_t{tally.fissions});
  put(std::uint64_t{tally.contact_changes});
  put(std::uint64_t{tally.impulses_given_up});
  put(std::uint64_t{tally.declared_soft});
  put(tally.kinematic_work);
  put(tally.placed_energy);
  put(tally.momentum_dropped);
  put(tally.depth);
  put(std::uint64_t{tally.squeezed});
  put(tally.squeezed_depth);
  put(tally.squeezed_share);
}
template <class Put>
void each_word(const Collision& c, Put&& put) {
  each_word(c.kind, put);
  each_word(c.key, put);
  put(pair_id(c.body1, c.body2));
  each_word(c.point, put);
  each_word(c.normal, put);
  put(c.speed);
  put(c.impulse);
  put(std::uint64_t{c.squeezed});
  put(c.depth);
}
template <class Put>
void each_word(const multibody::ServoGains& servo, Put&& put) {
  put(servo.stiffness);
  put(servo.damping);
  put(servo.max_torque);
}
// Rows: their length first.
template <class T, class Put>
void each_word(const std::vector<T>& row, Put&& put) {
  put(std::uint64_t{row.size()});
  for (const T& element : row) each_word(element, put);
}
template <class Put>
void each_word(const MultibodyStatePtr& joints, Put&& put) {
  if (!joints) return;
  for (const std::vector<double>* row :
       {&joints->q, &joints->u, &joints->torques, &joints->targets, &joints->target_velocities})
    each_word(*row, put);
  each_word(joints->servos, put);
  each_word(joints->stops, put);
  if (joints->base == Twist()) return;
  each_word(joints->base.v, put);
  each_word(joints->base.w, put);
}
template <class Put>
void each_word(const std::shared_ptr<const Report>& report, Put&& put) {
  put(std::uint64_t{report ? report->size() : 0});
  if (report)
    for (const Collision& told : *report) each_word(told, put);
}

}  // namespace tw
