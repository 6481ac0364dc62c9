// Rates of rotation vectors: R(t) = exp(theta(t)) R0, world frame.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "math/vec.h"

namespace tw {

// theta' of the angular velocity w: Jl(theta)^-1 w = w - theta x w/2 + c theta x (theta x w),
// c = (1 - (phi/2) cot(phi/2))/phi^2, phi = |theta| < 2 pi.
Vec3 rotation_vector_rate(const Vec3& theta, const Vec3& w);

// The angular velocity of theta' = rate: Jl(theta) rate = rate + p theta x rate + q theta x (theta
// x rate), p = (1 - cos phi)/phi^2, q = (phi - sin phi)/phi^3.  Never longer than the rate.
Vec3 angular_velocity(const Vec3& theta, const Vec3& rate);

// Its rate, with theta'' = change.
Vec3 angular_acceleration(const Vec3& theta, const Vec3& rate, const Vec3& change);

// The rotation vector of the shorter way from one orientation to another, |v| <= pi.
Vec3 turn_between(const Quat& from, const Quat& to);

// exp(theta/2), unit: as rotation_by, without sines where theta is short.
Quat short_rotation(const Vec3& theta);

}  // namespace tw
