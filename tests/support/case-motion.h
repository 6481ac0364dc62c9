// Where driven bodies of a case are (CaseMotion), as plain numbers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

#include "support/case-table.h"

namespace tw::test {

// A rigid motion at one instant: x -> turn x + shift, and its rates.
struct CasePlacement {
  double angle = 0, rate = 0;  // about the motion's axis
  Numbers3 shift{}, velocity{};
};

inline CasePlacement placement_at(const CaseMotion& motion, double time) {
  constexpr double pi = 3.14159265358979323846;
  const double omega = 2 * pi * motion.frequency;
  CasePlacement result;
  result.angle = motion.rate * time;
  result.rate = motion.rate;
  for (std::size_t i = 0; i < 3; ++i) {
    result.shift[i] = 0.5 * motion.swing[i] * (1 - std::cos(omega * time));
    result.velocity[i] = 0.5 * motion.swing[i] * omega * std::sin(omega * time);
  }
  return result;
}

inline Numbers3 cross(const Numbers3& a, const Numbers3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Rodrigues: x cos + n x x sin + n (n.x) (1 - cos).
inline Numbers3 turned(const Numbers3& x, const Numbers3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2];
  const Numbers3 across = cross(axis, x);
  Numbers3 result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = c * x[i] + s * across[i] + (1 - c) * along * axis[i];
  return result;
}

// The driven body as it is at a time: position, orientation and velocities.
inline CaseBody driven_body(const CaseBody& body, const CaseMotion& motion, double time) {
  const CasePlacement at = placement_at(motion, time);
  CaseBody result = body;
  result.position = turned(body.position, motion.axis, at.angle);
  const double c = std::cos(0.5 * at.angle), s = std::sin(0.5 * at.angle);
  // (c, s n) (w, v) = (c w - s n.v, c v + w s n + s n x v)
  const Numbers3 v{body.orientation[1], body.orientation[2], body.orientation[3]};
  const Numbers3& n = motion.axis;
  const double w = body.orientation[0];
  const Numbers3 across = cross(n, v);
  result.orientation[0] = c * w - s * (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]);
  const Numbers3 sweep = cross(n, result.position);
  for (std::size_t i = 0; i < 3; ++i) {
    result.orientation[i + 1] = c * v[i] + w * s * n[i] + s * across[i];
    result.angular_velocity[i] = at.rate * n[i];
    result.velocity[i] = at.rate * sweep[i] + at.velocity[i];
    result.position[i] += at.shift[i];
  }
  return result;
}

}  // namespace tw::test
