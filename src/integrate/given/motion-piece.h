// A short piece of a given motion: position and rotation vector as polynomials of time.
//
// In s = (time - middle)/half, -1 <= s <= 1 over the piece,
//   x(s) = sum x_k s^k,   R(s) = exp(theta(s)) R0,  theta(s) = sum theta_k s^k,   k <= degree.
// Velocity and angular velocity are the derivatives of just these, so that poses, rates and bounds
// tell of one curve.
//
// Fitted through the Lobatto points s_j = sin((j - 8) pi/16), j = 0..16: a polynomial of degree n =
// 2, 4, 8 through every (16/n)th of them; the others judge it.  Interpolation there misses a
// function by at most 3 times what its best polynomial does.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "integrate/trajectory.h"

namespace tw {

inline constexpr int motion_nodes = 17, most_motion_degree = 8;

// The time of a node of the piece from a to b; the first is a, the last b.
double motion_node_time(int node, double a, double b);

class MotionPiece {
 public:
  // Through every (16/degree)th of the poses at the nodes; degree 2, 4 or 8.
  MotionPiece(double start, double end, std::span<const Pose, motion_nodes> poses, int degree);
  // From one pose to another at constant velocity and angular velocity.
  MotionPiece(double start, double end, const Pose& from, const Pose& to);

  double start() const { return start_; }  // s
  double end() const { return end_; }
  int degree() const { return degree_; }

  Pose pose(double time) const;
  Twist twist(double time) const;
  PoseTwist at(double time) const;
  Twist twist_rates(double time) const;
  // Raises each to what the piece does within [from, to].
  void add_rates(double from, double to, MotionRates& most) const;
  // Widens the path, speed and turn of `bounds` by what the piece does within [from, to];
  void add_speeds(double from, double to, MotionBounds& bounds) const;
  // its acceleration and turn_change too.
  void add_changes(double from, double to, MotionBounds& bounds) const;

 private:
  using Coefficients = std::array<Vec3, most_motion_degree + 1>;

  double share(double time) const { return (time - middle_) / half_; }
  Vec3 value(const Coefficients& c, double s) const;
  Vec3 first(const Coefficients& c, double s) const;   // d/ds
  Vec3 second(const Coefficients& c, double s) const;  // d^2/ds^2
  void set_limits();

  double start_, end_, middle_, half_;
  int degree_;
  Quat q0_;
  Coefficients x_, theta_;
  // over the whole piece, by s: of each component of x'' and x''', of |theta''|, |theta'''| and
  // |theta x theta'|
  Vec3 second_x_, third_x_;
  double second_theta_, third_theta_, cross_theta_;
};

}  // namespace tw
