// How large and how small what a user gives may be.
//
// The limits lie far beyond what anyone simulates, and close enough that products of several such
// numbers (the inertia of a body is a density by a fifth power of lengths) stay well within
// doubles, and that sums of times and places still change.  Each is inclusive.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>

namespace tw {

// m: of radii, edges, widths and what places parts in shapes.  Below the size of atoms; beyond the
// orbit of Saturn.  Fifth powers: 1e-60 to 1e60.
inline constexpr double least_length = 1e-12, greatest_length = 1e12;

// Of one height field.
inline constexpr std::size_t most_heights = 1'000'000;

// m, of a coordinate of a body: doubles there are an eighth of a metre apart.
inline constexpr double farthest = 1e15;

// kg and kg/m^3.  Products of three with an inertia stay normal.
inline constexpr double least_mass = 1e-60, greatest_mass = 1e60;

// kg m^2: what the limits of mass and length allow, and a little more.
inline constexpr double least_inertia = 1e-90, greatest_inertia = 1e90;

// A body faster than this has run away, m/s: its windows would shrink to the spacing of doubles.
inline constexpr double speed_limit = 1e12;

// rad/s: points a metre away have the greatest speed.
inline constexpr double greatest_angular_speed = 1e12;

// m/s^2, of gravity and of what an applied force does: the greatest speed is reached within a
// second.
inline constexpr double greatest_acceleration = 1e12;

// rad/s^2, of what an applied torque does: the same.
inline constexpr double greatest_angular_acceleration = 1e12;

// s, of the time of anything: 30 years, where doubles are 1.2e-7 s apart.
inline constexpr double greatest_time = 1e9;

// s: ticks of this period can be counted, and told apart, up to the greatest time.
inline constexpr double least_period = 1e-6;

// 1/s, of frames and of contact checks: one period a tick.
inline constexpr double greatest_rate = 1e6;

// Of a run: more would each have next to nothing to do.
inline constexpr int most_threads = 256;

// N/m of contact stiffness, s/m of damping.
inline constexpr double least_stiffness = 1e-30, greatest_stiffness = 1e30;
inline constexpr double greatest_damping = 1e30;

// N/m of springs; N s/m of their damping and of linear drag; N s^2/m^2 of quadratic drag.
inline constexpr double greatest_force_constant = 1e30;

}  // namespace tw
