// Sweeps over the contacts of a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/contact-sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace tw {

namespace {

TW_LANES Lanes dot6(const Lanes* a, const Lanes* b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

// z += W p
TW_LANES void push_along(const Lanes* row, Lanes impulse, Lanes* z) {
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) z[i] += row[i] * impulse;
}

// The row of a direction at an arm; frame: 0..8 turning by rows, 9 the inverse root of the mass.
TW_LANES void set_row(const Lanes* frame, const LaneVec& arm, const LaneVec& direction, double sign,
                      Lanes* row) {
  const LaneVec turn = cross(arm, direction);
  const Lanes scale = sign * frame[9];
  row[0] = scale * direction.x;
  row[1] = scale * direction.y;
  row[2] = scale * direction.z;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i)
    row[3 + i] =
        sign * (frame[3 * i] * turn.x + frame[3 * i + 1] * turn.y + frame[3 * i + 2] * turn.z);
}

}  // namespace

void ContactSweeps::begin(std::span<const SweepMember> members) {
  const std::size_t count = members.size();
  change_.assign(count + 1, StepRow());
  moved_.assign(count + 1, StepRow());
  drive_.assign(count + 1, StepRow());
  frames_.assign(2 * count + 2, StepRow());
  for (std::size_t i = 0; i < count; ++i) {
    const SweepMember& member = members[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      drive_[i].at[k] = member.push[axis];
      drive_[i].at[3 + k] = member.twist[axis];
    }
    for (std::size_t k = 0; k < 9; ++k)
      frames_[2 * i + k / 8].at[k % 8] =
          member.turning(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
    frames_[2 * i + 1].at[1] = member.inverse_root_mass;
  }
}

// Batches by level; of a level those on the ground first.
void ContactSweeps::batch(std::span<const StepContact> contacts, std::size_t members) {
  order_.arrange(contacts, members);
  const auto kind = [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    return static_cast<std::size_t>(2 * order_.levels()[i] + (contacts[i].a < 0 ? 0 : 1));
  };
  places_.assign(2 * static_cast<std::size_t>(order_.level_count()), 0);
  for (const int number : order_.order()) ++places_[kind(number)];
  batches_.clear();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const int count = std::exchange(places_[k], static_cast<int>(batches_.size()) * lane_count);
    for (int done = 0; done < count; done += lane_count) {
      batches_.emplace_back();
      batches_.back().two = k % 2 == 1;
      std::fill_n(batches_.back().contact, lane_count, -1);
    }
  }
  tangents_.resize(batches_.size());
  for (const int number : order_.order()) {
    const int place = places_[kind(number)]++;
    batches_[static_cast<std::size_t>(place / lane_count)].contact[place % lane_count] = number;
  }
}

void ContactSweeps::set(Batch& batch, Tangents& tangents,
                        std::span<const StepContact> contacts) const {
  static const StepContact nothing;
  const int nobody = static_cast<int>(change_.size()) - 1;
  LaneVec n{}, arm_a{}, arm_b{}, velocity{}, tangential{};
  int frame_a[lane_count], frame_b[lane_count], rest_a[lane_count], rest_b[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) {
    const int number = batch.contact[lane];
    const StepContact& contact = number < 0 ? nothing : contacts[static_cast<std::size_t>(number)];
    batch.b[lane] = number < 0 ? nobody : contact.b;
    batch.a[lane] = contact.a < 0 ? nobody : contact.a;
    frame_a[lane] = 2 * batch.a[lane], rest_a[lane] = frame_a[lane] + 1;
    frame_b[lane] = 2 * batch.b[lane], rest_b[lane] = frame_b[lane] + 1;
    set_lane(n, lane, contact.normal);
    set_lane(arm_a, lane, contact.arm_a);
    set_lane(arm_b, lane, contact.arm_b);
    set_lane(velocity, lane, contact.velocity);
    set_lane(tangential, lane, contact.tangential);
    batch.gap0[lane] = contact.gap;
    batch.normal[lane] = contact.impulse;
    batch.friction[lane] = contact.friction;
    batch.restitution[lane] = contact.restitution;
  }
  const Lanes zero = lanes(0), one = lanes(1);
  // any two tangents: square to n, and to x, or to y where n is near x (within 55 degrees)
  const LaneMask flat = n.x * n.x < lanes(0.3249);
  const LaneVec axis{flat ? one : zero, flat ? zero : one, zero};
  tangents.t1 = cross(n, axis);
  tangents.t1 = (one / sqrt(dot(tangents.t1, tangents.t1))) * tangents.t1;
  tangents.t2 = cross(n, tangents.t1);

  Lanes frame[16];
  const LaneVec* const directions[3] = {&n, &tangents.t1, &tangents.t2};
  Lanes stiffness[3];
  gather_rows(frames_.data(), frame_b, frame);
  gather_rows(frames_.data(), rest_b, frame + 8);
  for (int d = 0; d < 3; ++d) {
    set_row(frame, arm_b, *directions[d], 1, batch.of_b[d]);
    stiffness[d] = dot6(batch.of_b[d], batch.of_b[d]);
    batch.start[d] = dot(*directions[d], velocity);
  }
  gather_rows(frames_.data(), frame_a, frame);
  gather_rows(frames_.data(), rest_a, frame + 8);
  for (int d = 0; d < 3; ++d) {
    set_row(frame, arm_a, *directions[d], -1, batch.of_a[d]);
    stiffness[d] += dot6(batch.of_a[d], batch.of_a[d]);
  }
  const LaneMask some = stiffness[0] > zero;
  batch.mass = some ? one / stiffness[0] : zero;
  batch.tangential_mass = some ? lanes(2) / (stiffness[1] + stiffness[2]) : zero;
  batch.tangent1 = dot(tangents.t1, tangential);
  batch.tangent2 = dot(tangents.t2, tangential);
  batch.most = zero;
  batch.gap = batch.gap0;
}

void ContactSweeps::drive(double time) {
  for (std::size_t i = 0; i + 1 < change_.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) change_[i].at[k] += time * drive_[i].at[k];
}

void ContactSweeps::move(double time) {
  for (std::size_t i = 0; i + 1 < change_.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) moved_[i].at[k] += time * change_[i].at[k];
}

// Calls visit(batch, z of b, z of a) and puts both back.
template <class Visit>
TW_LANES void ContactSweeps::each_batch(Visit&& visit) {
  Lanes b[8], a[8] = {};
  for (Batch& batch : batches_) {
    gather_rows(change_.data(), batch.b, b);
    if (batch.two) gather_rows(change_.data(), batch.a, a);
    visit(batch, b, a);
    scatter_rows(change_.data(), batch.b, b);
    if (batch.two) scatter_rows(change_.data(), batch.a, a);
  }
}

void ContactSweeps::warm_start() {
  each_batch([](Batch& batch, Lanes* b, Lanes* a) TW_LANES_LAMBDA {
    const Lanes impulse[3] = {batch.normal, batch.tangent1, batch.tangent2};
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
      push_along(batch.of_b[d], impulse[d], b);
      if (batch.two) push_along(batch.of_a[d], impulse[d], a);
    }
  });
}

template <bool pushing>
void ContactSweeps::sweep(double inverse_time, const Spring& spring,
                          const Spring& spring_of_ground) {
  each_batch([&](Batch& batch, Lanes* b, Lanes* a) TW_LANES_LAMBDA {
    const Lanes zero = lanes(0), one = lanes(1);
    const auto along = [&](int d) TW_LANES_LAMBDA {
      const Lanes u = batch.start[d] + dot6(batch.of_b[d], b);
      return batch.two ? u + dot6(batch.of_a[d], a) : u;
    };
    const auto add = [&](int d, Lanes impulse) TW_LANES_LAMBDA {
      push_along(batch.of_b[d], impulse, b);
      if (batch.two) push_along(batch.of_a[d], impulse, a);
    };
    const LaneMask open = batch.gap > zero;
    const Lanes u = along(0);
    Lanes wanted;
    if constexpr (pushing) {
      const Spring& soft = batch.two ? spring : spring_of_ground;
      const Lanes most = lanes(-stepping::fastest_push);
      const Lanes bias = open ? batch.gap * inverse_time : max(batch.gap * soft.rate, most);
      wanted = -batch.mass * (open ? one : lanes(soft.k)) * (u + bias) -
               (open ? zero : lanes(soft.s)) * batch.normal;
    } else {
      wanted = -batch.mass * (u + (open ? batch.gap * inverse_time : zero));
    }
    const Lanes normal = max(batch.normal + wanted, zero);
    add(0, normal - batch.normal);
    batch.normal = normal;
    batch.most = max(batch.most, normal);

    Lanes t1 = batch.tangent1 - batch.tangential_mass * along(1);
    Lanes t2 = batch.tangent2 - batch.tangential_mass * along(2);
    const Lanes squared = t1 * t1 + t2 * t2, limit = batch.friction * normal;
    const LaneMask slips = squared > limit * limit;
    if (any(slips)) {
      const Lanes share = slips ? limit / sqrt(squared) : one;
      t1 *= share;
      t2 *= share;
    }
    add(1, t1 - batch.tangent1);
    add(2, t2 - batch.tangent2);
    batch.tangent1 = t1;
    batch.tangent2 = t2;
  });
}

void ContactSweeps::update_gaps(double time) {
  Lanes b[8], a[8];
  for (Batch& batch : batches_) {
    gather_rows(moved_.data(), batch.b, b);
    Lanes gap = batch.gap0 + time * batch.start[0] + dot6(batch.of_b[0], b);
    if (batch.two) {
      gather_rows(moved_.data(), batch.a, a);
      gap += dot6(batch.of_a[0], a);
    }
    batch.gap = gap;
  }
}

void ContactSweeps::restitute() {
  each_batch([](Batch& batch, Lanes* b, Lanes* a) TW_LANES_LAMBDA {
    const Lanes zero = lanes(0);
    const LaneMask hit = (batch.start[0] < lanes(-stepping::least_bounce)) & (batch.most > zero) &
                         (batch.restitution > zero);
    if (!any(hit)) return;
    Lanes u = batch.start[0] + dot6(batch.of_b[0], b);
    if (batch.two) u += dot6(batch.of_a[0], a);
    const Lanes bounced =
        max(batch.normal - batch.mass * (u + batch.restitution * batch.start[0]), zero);
    const Lanes impulse = hit ? bounced - batch.normal : zero;
    push_along(batch.of_b[0], impulse, b);
    if (batch.two) push_along(batch.of_a[0], impulse, a);
    batch.normal += impulse;
  });
}

void ContactSweeps::tell(std::span<StepContact> contacts) const {
  for (std::size_t i = 0; i < batches_.size(); ++i) {
    const Batch& batch = batches_[i];
    const Tangents& tangents = tangents_[i];
    const LaneVec force = batch.tangent1 * tangents.t1 + batch.tangent2 * tangents.t2;
    for (int lane = 0; lane < lane_count; ++lane) {
      if (batch.contact[lane] < 0) continue;
      StepContact& contact = contacts[static_cast<std::size_t>(batch.contact[lane])];
      contact.impulse = batch.normal[lane];
      contact.tangential = Vec3(force.x[lane], force.y[lane], force.z[lane]);
    }
  }
}

void ContactSweeps::solve(std::span<const SweepMember> members, const SweepTimes& times,
                          std::span<StepContact> contacts) {
  begin(members);
  batch(contacts, members.size());
  for (std::size_t i = 0; i < batches_.size(); ++i) set(batches_[i], tangents_[i], contacts);
  const double hs = times.step / times.substeps;
  const auto spring = [&](double share) {
    const double w = 2 * pi * share * times.substeps / times.unhalved;
    const double damped = 2 * stepping::damping_ratio + hs * w;
    const double s = 1 / (1 + hs * w * damped);
    return Spring{w / damped, 1 - s, s};
  };
  const Spring soft = spring(stepping::push_rate), firm = spring(2 * stepping::push_rate);
  const double inverse = 1 / hs, half = hs / 2;
  update_gaps(half);
  for (int substep = 0; substep < times.substeps; ++substep) {
    drive(hs);
    warm_start();
    for (int i = 0; i < times.pushing; ++i) sweep<true>(inverse, soft, firm);
    move(half);
    if (substep == times.substeps - 1) at_end_ = moved_;
    move(half);
    update_gaps((substep + 1.5) * hs);
    for (int i = 0; i < times.relaxing; ++i) sweep<false>(inverse, soft, firm);
  }
  restitute();
  tell(contacts);
}

}  // namespace tw
