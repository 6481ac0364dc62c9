// Sweeps over the contacts of a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/stepped/contact-sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"

namespace tw {

namespace {

using step_lanes::any;
using step_lanes::gather;
using step_lanes::root;
using step_lanes::scatter;

template <class V>
TW_LANES V dot3(const V* a, const V* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class V>
TW_LANES V dot6(const V* a, const V* b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}
template <class V>
TW_LANES void cross3(const V* a, const V* b, V* c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}
template <class V>
TW_LANES V larger(V a, V b) {
  return a > b ? a : b;
}
// z += W p
template <class V>
TW_LANES void push(const V* row, V impulse, V* z) {
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) z[i] += row[i] * impulse;
}

// The row of a direction at an arm; frame: 0..8 turning by rows, 9 the inverse root of the mass.
template <class V>
TW_LANES void set_row(const V* frame, const V* arm, const V* direction, V sign, V* row) {
  V turn[3];
  cross3(arm, direction, turn);
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    row[i] = sign * frame[9] * direction[i];
    row[3 + i] = sign * dot3(frame + 3 * i, turn);
  }
}

}  // namespace

template <class Number>
void ContactSweeps<Number>::begin(std::span<const SweepMember> members) {
  const std::size_t count = members.size();
  change_.assign(count + 1, Row());
  moved_.assign(count + 1, Row());
  drive_.assign(count + 1, Row());
  frames_.assign(2 * count + 2, Row());
  for (std::size_t i = 0; i < count; ++i) {
    const SweepMember& member = members[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      drive_[i].at[k] = static_cast<Number>(member.push[axis]);
      drive_[i].at[3 + k] = static_cast<Number>(member.twist[axis]);
    }
    for (std::size_t k = 0; k < 9; ++k)
      frames_[2 * i + k / 8].at[k % 8] = static_cast<Number>(
          member.turning(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)));
    frames_[2 * i + 1].at[1] = static_cast<Number>(member.inverse_root_mass);
  }
}

// Batches by level; of a level those on the ground first.
template <class Number>
void ContactSweeps<Number>::batch(std::span<const StepContact> contacts, std::size_t members) {
  order_.arrange(contacts, members);
  const auto kind = [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    return static_cast<std::size_t>(2 * order_.levels()[i] + (contacts[i].a < 0 ? 0 : 1));
  };
  places_.assign(2 * static_cast<std::size_t>(order_.level_count()), 0);
  for (const int number : order_.order()) ++places_[kind(number)];
  batches_.clear();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const int count = std::exchange(places_[k], static_cast<int>(batches_.size()) * width);
    for (int done = 0; done < count; done += width) {
      batches_.emplace_back();
      batches_.back().two = k % 2 == 1;
      std::fill_n(batches_.back().contact, width, -1);
    }
  }
  tangents_.resize(batches_.size());
  for (const int number : order_.order()) {
    const int place = places_[kind(number)]++;
    batches_[static_cast<std::size_t>(place / width)].contact[place % width] = number;
  }
}

template <class Number>
void ContactSweeps<Number>::set(Batch& batch, Tangents& tangents,
                                std::span<const StepContact> contacts) const {
  static const StepContact nothing;
  const int nobody = static_cast<int>(change_.size()) - 1;
  V n[3], arm_a[3], arm_b[3], velocity[3], tangential[3];
  int frame_a[width], frame_b[width], rest_a[width], rest_b[width];
  for (int lane = 0; lane < width; ++lane) {
    const int number = batch.contact[lane];
    const StepContact& contact = number < 0 ? nothing : contacts[static_cast<std::size_t>(number)];
    batch.b[lane] = number < 0 ? nobody : contact.b;
    batch.a[lane] = contact.a < 0 ? nobody : contact.a;
    frame_a[lane] = 2 * batch.a[lane], rest_a[lane] = frame_a[lane] + 1;
    frame_b[lane] = 2 * batch.b[lane], rest_b[lane] = frame_b[lane] + 1;
    for (int k = 0; k < 3; ++k) {
      n[k][lane] = static_cast<Number>(contact.normal[k]);
      arm_a[k][lane] = static_cast<Number>(contact.arm_a[k]);
      arm_b[k][lane] = static_cast<Number>(contact.arm_b[k]);
      velocity[k][lane] = static_cast<Number>(contact.velocity[k]);
      tangential[k][lane] = static_cast<Number>(contact.tangential[k]);
    }
    batch.gap0[lane] = static_cast<Number>(contact.gap);
    batch.normal[lane] = static_cast<Number>(contact.impulse);
    batch.friction[lane] = static_cast<Number>(contact.friction);
    batch.restitution[lane] = static_cast<Number>(contact.restitution);
  }
  const V zero = V{}, one = zero + 1;
  // any two tangents: square to n, and to the axis that n is least along of x and y
  const auto flat = n[0] * n[0] < zero + Number(0.3249);
  const V axis[3] = {flat ? one : zero, flat ? zero : one, zero};
  cross3(n, axis, tangents.t1);
  const V length = one / root(dot3(tangents.t1, tangents.t1));
  for (V& t : tangents.t1) t *= length;
  cross3(n, tangents.t1, tangents.t2);

  V frame[16];
  const V* const directions[3] = {n, tangents.t1, tangents.t2};
  V stiffness[3] = {zero, zero, zero};
  gather(frames_.data(), frame_b, frame);
  gather(frames_.data(), rest_b, frame + 8);
  for (int d = 0; d < 3; ++d) {
    set_row(frame, arm_b, directions[d], one, batch.of_b[d]);
    stiffness[d] += dot6(batch.of_b[d], batch.of_b[d]);
    batch.start[d] = dot3(directions[d], velocity);
  }
  gather(frames_.data(), frame_a, frame);
  gather(frames_.data(), rest_a, frame + 8);
  for (int d = 0; d < 3; ++d) {
    set_row(frame, arm_a, directions[d], -one, batch.of_a[d]);
    stiffness[d] += dot6(batch.of_a[d], batch.of_a[d]);
  }
  const auto some = stiffness[0] > zero;
  batch.mass = some ? one / stiffness[0] : zero;
  batch.tangential_mass = some ? (one + one) / (stiffness[1] + stiffness[2]) : zero;
  batch.tangent1 = dot3(tangents.t1, tangential);
  batch.tangent2 = dot3(tangents.t2, tangential);
  batch.most = zero;
  batch.gap = batch.gap0;
}

template <class Number>
void ContactSweeps<Number>::drive(Number time) {
  for (std::size_t i = 0; i + 1 < change_.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) change_[i].at[k] += time * drive_[i].at[k];
}

template <class Number>
void ContactSweeps<Number>::move(Number time) {
  for (std::size_t i = 0; i + 1 < change_.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) moved_[i].at[k] += time * change_[i].at[k];
}

// Calls visit(batch, z of b, z of a) and puts both back.
template <class Number>
template <class Visit>
TW_LANES void ContactSweeps<Number>::each_batch(Visit&& visit) {
  V b[8], a[8] = {};
  for (Batch& batch : batches_) {
    gather(change_.data(), batch.b, b);
    if (batch.two) gather(change_.data(), batch.a, a);
    visit(batch, b, a);
    scatter(change_.data(), batch.b, b);
    if (batch.two) scatter(change_.data(), batch.a, a);
  }
}

template <class Number>
void ContactSweeps<Number>::warm_start() {
  each_batch([](Batch& batch, V* b, V* a) TW_LANES_LAMBDA {
    const V impulse[3] = {batch.normal, batch.tangent1, batch.tangent2};
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
      push(batch.of_b[d], impulse[d], b);
      if (batch.two) push(batch.of_a[d], impulse[d], a);
    }
  });
}

template <class Number>
template <bool pushing>
void ContactSweeps<Number>::sweep(Number inverse_time, const Spring& spring,
                                  const Spring& spring_of_ground) {
  each_batch([&](Batch& batch, V* b, V* a) TW_LANES_LAMBDA {
    const V zero = V{}, one = zero + 1;
    const auto along = [&](int d) TW_LANES_LAMBDA {
      const V u = batch.start[d] + dot6(batch.of_b[d], b);
      return batch.two ? u + dot6(batch.of_a[d], a) : u;
    };
    const auto add = [&](int d, V impulse) TW_LANES_LAMBDA {
      push(batch.of_b[d], impulse, b);
      if (batch.two) push(batch.of_a[d], impulse, a);
    };
    const auto open = batch.gap > zero;
    const V u = along(0);
    V wanted;
    if constexpr (pushing) {
      const Spring& soft = batch.two ? spring : spring_of_ground;
      const V most = zero - Number(stepping::fastest_push);
      const V bias = open ? batch.gap * inverse_time : larger(batch.gap * soft.rate, most);
      wanted = -batch.mass * (open ? one : zero + soft.k) * (u + bias) -
               (open ? zero : zero + soft.s) * batch.normal;
    } else {
      wanted = -batch.mass * (u + (open ? batch.gap * inverse_time : zero));
    }
    const V normal = larger(batch.normal + wanted, zero);
    add(0, normal - batch.normal);
    batch.normal = normal;
    batch.most = larger(batch.most, normal);

    V t1 = batch.tangent1 - batch.tangential_mass * along(1);
    V t2 = batch.tangent2 - batch.tangential_mass * along(2);
    const V squared = t1 * t1 + t2 * t2, limit = batch.friction * normal;
    const auto slips = squared > limit * limit;
    if (any(slips)) {
      const V share = slips ? limit / root(squared) : one;
      t1 *= share;
      t2 *= share;
    }
    add(1, t1 - batch.tangent1);
    add(2, t2 - batch.tangent2);
    batch.tangent1 = t1;
    batch.tangent2 = t2;
  });
}

template <class Number>
void ContactSweeps<Number>::update_gaps(Number time) {
  V b[8], a[8];
  for (Batch& batch : batches_) {
    gather(moved_.data(), batch.b, b);
    V gap = batch.gap0 + time * batch.start[0] + dot6(batch.of_b[0], b);
    if (batch.two) {
      gather(moved_.data(), batch.a, a);
      gap += dot6(batch.of_a[0], a);
    }
    batch.gap = gap;
  }
}

template <class Number>
void ContactSweeps<Number>::restitute() {
  each_batch([](Batch& batch, V* b, V* a) TW_LANES_LAMBDA {
    const V zero = V{};
    const auto hit = (batch.start[0] < zero - Number(stepping::least_bounce)) &
                     (batch.most > zero) & (batch.restitution > zero);
    if (!any(hit)) return;
    V u = batch.start[0] + dot6(batch.of_b[0], b);
    if (batch.two) u += dot6(batch.of_a[0], a);
    const V bounced =
        larger(batch.normal - batch.mass * (u + batch.restitution * batch.start[0]), zero);
    const V impulse = hit ? bounced - batch.normal : zero;
    push(batch.of_b[0], impulse, b);
    if (batch.two) push(batch.of_a[0], impulse, a);
    batch.normal += impulse;
  });
}

template <class Number>
void ContactSweeps<Number>::tell(std::span<StepContact> contacts) const {
  for (std::size_t i = 0; i < batches_.size(); ++i) {
    const Batch& batch = batches_[i];
    const Tangents& tangents = tangents_[i];
    for (int lane = 0; lane < width; ++lane) {
      if (batch.contact[lane] < 0) continue;
      StepContact& contact = contacts[static_cast<std::size_t>(batch.contact[lane])];
      contact.impulse = static_cast<double>(batch.normal[lane]);
      for (int k = 0; k < 3; ++k)
        contact.tangential[k] = static_cast<double>(tangents.t1[k][lane] * batch.tangent1[lane] +
                                                    tangents.t2[k][lane] * batch.tangent2[lane]);
    }
  }
}

template <class Number>
void ContactSweeps<Number>::solve(std::span<const SweepMember> members, const SweepTimes& times,
                                  std::span<StepContact> contacts) {
  begin(members);
  batch(contacts, members.size());
  for (std::size_t i = 0; i < batches_.size(); ++i) set(batches_[i], tangents_[i], contacts);
  const double hs = times.step / times.substeps;
  const auto spring = [&](double share) {
    const double w = 2 * pi * share * times.substeps / times.unhalved,
                 damped = 2 * stepping::damping_ratio + hs * w;
    const double s = 1 / (1 + hs * w * damped);
    return Spring{static_cast<Number>(w / damped), static_cast<Number>(1 - s),
                  static_cast<Number>(s)};
  };
  const Spring soft = spring(stepping::push_rate), firm = spring(2 * stepping::push_rate);
  const auto time = static_cast<Number>(hs), inverse = static_cast<Number>(1 / hs);
  const Number half = time / 2;
  update_gaps(half);
  for (int substep = 0; substep < times.substeps; ++substep) {
    drive(time);
    warm_start();
    for (int i = 0; i < times.pushing; ++i) sweep<true>(inverse, soft, firm);
    move(half);
    if (substep == times.substeps - 1) at_end_ = moved_;
    move(half);
    update_gaps(static_cast<Number>((substep + 1.5) * hs));
    for (int i = 0; i < times.relaxing; ++i) sweep<false>(inverse, soft, firm);
  }
  restitute();
  tell(contacts);
}

template class ContactSweeps<double>;
template class ContactSweeps<float>;

}  // namespace tw
