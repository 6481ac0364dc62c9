// Positions q and velocities u of a multibody: steps between positions, rates, charts.
//
// Positions are a manifold.  A displacement z (nv numbers, in the order of u) leads from one to
// another: scalars add; of a spherical joint R = R0 exp(z), z in the link's frame; of a free link
// x = x0 + z, R = exp(z) R0, z in the world.  z is also the chart of an integrator's step, good to
// |z| < 2 pi, at whose start z' = u.
//
// Every span has the length nq or nv of the tree; in and out may be the same.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "multibody/tree.h"

namespace tw::multibody {

using In = std::span<const double>;
using Out = std::span<double>;

// All joints at 0, free links at the origin of the world.
void neutral_position(const Tree& tree, Out q);
// q (nq) from q0 (nq) by z (nv); unit quaternions.
void displace(const Tree& tree, In q0, In z, Out q);
// The z of the shorter ways from q0 to q.
void difference(const Tree& tree, In q0, In q, Out z);
// Quaternions to unit length.
void normalize(const Tree& tree, Out q);

// q' (nq): of a quaternion 1/2 q (0, w) or 1/2 (0, w) q.
void position_rate(const Tree& tree, In q, In u, Out rate);
// z' (nv) in the chart of a step: G(z, u).
void chart_rate(const Tree& tree, In z, In u, Out rate);
// r := (s 1 - Gz)^-1 r at z = 0, where Gz = dG/dz is -1/2 [w]x of spherical joints, 1/2 [w]x of
// free links, else 0; dG/du is the unit matrix there.  s > 0, 1/s.
void solve_chart_rate(const Tree& tree, In u, double s, Out r);

// Quaternions lie as w x y z.
inline Quat quaternion_at(const double* q) { return Quat(q[0], q[1], q[2], q[3]); }
inline void set_quaternion(double* q, const Quat& value) {
  q[0] = value.w(), q[1] = value.x(), q[2] = value.y(), q[3] = value.z();
}
inline Vec3 vector_at(const double* x) { return Vec3(x[0], x[1], x[2]); }
inline void set_vector(double* x, const Vec3& value) {
  x[0] = value.x(), x[1] = value.y(), x[2] = value.z();
}

}  // namespace tw::multibody
