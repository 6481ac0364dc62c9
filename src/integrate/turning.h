// Which way a turn changes, of a motion that is a rotation vector from the start of its step on.
//
// With w = J(theta) theta' and J = 1 + A [theta]x + B [theta]x [theta]x, A <= 1/2, B <= 1/6:
//   |n x w'| <= |n x theta''| + (1/2 + |theta|/6) |theta x theta''| + |theta'| |theta x theta'|/6.
// What turns about a fixed axis has none of the last two, and what turns about n nothing at all.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>

#include "math/vec.h"

namespace tw {

// A bound on |n x w'|, rad/s^2, n a unit vector; theta (rad) and its rates lie within these points.
inline double turn_change_across(const Vec3& n, std::span<const Vec3> theta,
                                 std::span<const Vec3> rate, std::span<const Vec3> second) {
  const auto longest = [](std::span<const Vec3> points) {
    double squared = 0;
    for (const Vec3& p : points) squared = std::max(squared, p.squaredNorm());
    return std::sqrt(squared);
  };
  const auto widest = [](std::span<const Vec3> some, std::span<const Vec3> others) {
    double squared = 0;
    for (const Vec3& p : some)
      for (const Vec3& q : others) squared = std::max(squared, p.cross(q).squaredNorm());
    return std::sqrt(squared);
  };
  return (1 + 1e-12) *
         (widest({&n, 1}, second) + (0.5 + longest(theta) / 6) * widest(theta, second) +
          longest(rate) * widest(theta, rate) / 6);
}

}  // namespace tw
