// Rows of numbers and lanes of a group's state: how they are read, written and summed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstring>

#include "base/index.h"
#include "integrate/implicit/group-system.h"

namespace tw::rows {

TW_LANES LaneVec load(const double* p) {
  LaneVec v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

TW_LANES void store(const LaneVec& v, double* p) { std::memcpy(p, &v, sizeof v); }

inline Eigen::Map<Vec3> vec(double* p) { return Eigen::Map<Vec3>(p); }
inline Eigen::Map<const Vec3> vec(const double* p) { return Eigen::Map<const Vec3>(p); }

inline Quat quat(const double* p) { return Quat(p[0], p[1], p[2], p[3]); }
inline void store(const Quat& q, double* p) {
  p[0] = q.w();
  p[1] = q.x();
  p[2] = q.y();
  p[3] = q.z();
}

inline void store_rotation(const Mat3& m, double* R) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) R[3 * r + c] = m(r, c);
}

TW_LANES void add(const LaneVec& v, int lane, double sign, double* to) {
  to[0] += sign * v.x[lane];
  to[1] += sign * v.y[lane];
  to[2] += sign * v.z[lane];
}

TW_LANES void add_sum(const LaneVec& v, double sign, double* to) {
  to[0] += sign * sum(v.x);
  to[1] += sign * sum(v.y);
  to[2] += sign * sum(v.z);
}

// f on b and -f on a, with their torques; those on outside bodies count for nothing where all are
TW_LANES void scatter(const ContactPack& pack, const LaneVec& f, const LaneVec& torque_a,
                      const LaneVec& torque_b, BodyWrench* wrenches) {
  if (pack.uniform) {
    BodyWrench &a = wrenches[pack.a[0]], &b = wrenches[pack.b[0]];
    add_sum(f, 1, b.f);
    add_sum(torque_b, 1, b.t);
    if (pack.grounded) return;
    add_sum(f, -1, a.f);
    add_sum(torque_a, -1, a.t);
    return;
  }
  for (int i = 0; i < pack.count; ++i) {
    BodyWrench &a = wrenches[pack.a[i]], &b = wrenches[pack.b[i]];
    add(f, i, 1, b.f);
    add(torque_b, i, 1, b.t);
    add(f, i, -1, a.f);
    add(torque_a, i, -1, a.t);
  }
}

TW_LANES void scatter_change(const ContactPack& pack, const PackLinear& linear,
                             const PackChange& change, BodyWrench* wrenches) {
  LaneVec on_a = cross(linear.sa, change.f) + cross(change.sa, linear.f);
  LaneVec on_b = cross(linear.sb, change.f) + cross(change.sb, linear.f);
  if (linear.turns) {
    on_a = on_a + change.torque;
    on_b = on_b + change.torque;
  }
  scatter(pack, change.f, on_a, on_b, wrenches);
}

}  // namespace tw::rows
