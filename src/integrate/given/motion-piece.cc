// A short piece of a given motion.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/given/motion-piece.h"

#include <algorithm>
#include <cmath>

#include "math/rotation-vector.h"

namespace tw {
namespace {

// s_j, increasing; -1, 0 and 1 are exact
double node(int j) { return std::sin((j - 8) * pi / 16); }

// From values at the nodes of a degree to the coefficients of powers of s.
struct FitMatrix {
  double entry[most_motion_degree + 1][most_motion_degree + 1] = {};

  // Values to Chebyshev coefficients, c_k = (2/n) sum'' f_j T_k(s_j) (first and last halved, in j
  // and in k), those to powers of s by T_(k+1) = 2 s T_k - T_(k-1).
  explicit FitMatrix(int n) {
    double power[most_motion_degree + 1][most_motion_degree + 1] = {};  // [k][i]: of s^i in T_k
    power[0][0] = power[1][1] = 1;
    for (int k = 1; k < n; ++k)
      for (int i = 0; i <= n; ++i)
        power[k + 1][i] = (i > 0 ? 2 * power[k][i - 1] : 0) - power[k - 1][i];
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const double halves = (j == 0 || j == n ? 0.5 : 1) * (k == 0 || k == n ? 0.5 : 1);
        // nodes increase: s_j = -cos(j pi/n)
        const double chebyshev = 2.0 / n * halves * std::cos(k * (n - j) * pi / n);
        for (int i = 0; i <= n; ++i) entry[i][j] += chebyshev * power[k][i];
      }
  }
};

const FitMatrix& fit_matrix(int degree) {
  static const FitMatrix two(2), four(4), eight(8);
  return degree == 2 ? two : degree == 4 ? four : eight;
}

}  // namespace

double motion_node_time(int j, double a, double b) {
  if (j == 0 || j == motion_nodes - 1) return j == 0 ? a : b;
  return 0.5 * (a + b) + 0.5 * (b - a) * node(j);
}

MotionPiece::MotionPiece(double start, double end, std::span<const Pose, motion_nodes> poses,
                         int degree)
    : start_(start),
      end_(end),
      middle_(0.5 * (start + end)),
      half_(0.5 * (end - start)),
      degree_(degree),
      q0_(poses[(motion_nodes - 1) / 2].q) {
  x_.fill(Vec3::Zero());
  theta_.fill(Vec3::Zero());
  const FitMatrix& fit = fit_matrix(degree);
  for (int j = 0; j <= degree; ++j) {
    const Pose& pose = poses[static_cast<std::size_t>(j * (motion_nodes - 1) / degree)];
    // from the pose in the middle: what stands still has no rounding
    const Vec3 shift = pose.p - poses[(motion_nodes - 1) / 2].p, turn = turn_between(q0_, pose.q);
    for (int i = 0; i <= degree; ++i) {
      x_[static_cast<std::size_t>(i)] += fit.entry[i][j] * shift;
      theta_[static_cast<std::size_t>(i)] += fit.entry[i][j] * turn;
    }
  }
  x_[0] += poses[(motion_nodes - 1) / 2].p;
  set_limits();
}

MotionPiece::MotionPiece(double start, double end, const Pose& from, const Pose& to)
    : start_(start),
      end_(end),
      middle_(0.5 * (start + end)),
      half_(0.5 * (end - start)),
      degree_(1),
      q0_(from.q) {
  x_.fill(Vec3::Zero());
  theta_.fill(Vec3::Zero());
  x_[1] = 0.5 * (to.p - from.p);
  x_[0] = from.p + x_[1];
  theta_[0] = theta_[1] = 0.5 * turn_between(from.q, to.q);
  set_limits();
}

// |c_k s^k| <= |c_k|
void MotionPiece::set_limits() {
  second_x_ = third_x_ = Vec3::Zero();
  second_theta_ = third_theta_ = cross_theta_ = 0;
  for (int k = 2; k <= degree_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double two = k * (k - 1), three = two * (k - 2);
    second_x_ += two * x_[i].cwiseAbs();
    third_x_ += three * x_[i].cwiseAbs();
    second_theta_ += two * theta_[i].norm();
    third_theta_ += three * theta_[i].norm();
  }
  // theta x theta' = sum over i < j of (j - i) theta_i x theta_j s^(i+j-1)
  for (int i = 0; i <= degree_; ++i)
    for (int j = i + 1; j <= degree_; ++j)
      cross_theta_ +=
          (j - i) *
          theta_[static_cast<std::size_t>(i)].cross(theta_[static_cast<std::size_t>(j)]).norm();
}

Vec3 MotionPiece::value(const Coefficients& c, double s) const {
  Vec3 sum = c[static_cast<std::size_t>(degree_)];
  for (int k = degree_ - 1; k >= 0; --k) sum = sum * s + c[static_cast<std::size_t>(k)];
  return sum;
}

Vec3 MotionPiece::first(const Coefficients& c, double s) const {
  Vec3 sum = degree_ * c[static_cast<std::size_t>(degree_)];
  for (int k = degree_ - 1; k >= 1; --k) sum = sum * s + k * c[static_cast<std::size_t>(k)];
  return sum;
}

Vec3 MotionPiece::second(const Coefficients& c, double s) const {
  Vec3 sum = Vec3::Zero();
  for (int k = degree_; k >= 2; --k) sum = sum * s + k * (k - 1) * c[static_cast<std::size_t>(k)];
  return sum;
}

Pose MotionPiece::pose(double time) const {
  const double s = share(time);
  return {value(x_, s), short_rotation(value(theta_, s)) * q0_};
}

Twist MotionPiece::twist(double time) const {
  const double s = share(time), rate = 1 / half_;
  return {rate * first(x_, s), angular_velocity(value(theta_, s), rate * first(theta_, s))};
}

PoseTwist MotionPiece::at(double time) const {
  const Pose there = pose(time);
  const Twist rates = twist(time);
  return {there.p, there.q, rates.v, rates.w};
}

Twist MotionPiece::twist_rates(double time) const {
  const double s = share(time), rate = 1 / half_;
  return {
      rate * rate * second(x_, s),
      rate * rate * angular_acceleration(value(theta_, s), first(theta_, s), second(theta_, s))};
}

// As below; w = J(theta) theta' with |J'| < |theta'|.
void MotionPiece::add_rates(double from, double to, MotionRates& most) const {
  const double s0 = share(std::max(from, start_)), s1 = share(std::min(to, end_));
  const double m = 0.5 * (s0 + s1), d = 0.5 * (s1 - s0), rate = 1 / half_;
  constexpr double widen = 1 + 1e-12;
  const auto raise = [&](double& known, int order, double value) {
    known = std::max(known, widen * std::pow(rate, order) * value);
  };
  raise(most.speed, 1, (first(x_, m).cwiseAbs() + d * second_x_).norm());
  raise(most.acceleration, 2, (second(x_, m).cwiseAbs() + d * third_x_).norm());
  raise(most.jerk, 3, third_x_.norm());
  const double turn = first(theta_, m).norm() + d * second_theta_;
  const double change = second(theta_, m).norm() + d * third_theta_;
  raise(most.turn, 1, turn);
  raise(most.turn_change, 2, change + turn * turn);
  raise(most.turn_jerk, 3, third_theta_ + 3 * turn * change + turn * turn * turn);
}

// By the values at the middle m of [from, to] and d = half its length: f(m) +- d max|f'|.
void MotionPiece::add_speeds(double from, double to, MotionBounds& bounds) const {
  const double s0 = share(std::max(from, start_)), s1 = share(std::min(to, end_));
  const double m = 0.5 * (s0 + s1), d = 0.5 * (s1 - s0), rate = 1 / half_;
  const Vec3 x = value(x_, m), v = first(x_, m);
  // rounding of the sums: each is that of a few terms no larger than the largest coordinate
  const double rounding = 4e-15 * x.cwiseAbs().maxCoeff();
  const Vec3 reach =
      d * v.cwiseAbs() + (0.5 * d * d) * second_x_ + Vec3::Constant(rounding + 1e-15 * v.norm());
  bounds.path.add(Vec3(x - reach));
  bounds.path.add(Vec3(x + reach));
  constexpr double widen = 1 + 1e-12;
  bounds.speed = std::max(bounds.speed, widen * rate * (v.cwiseAbs() + d * second_x_).norm());
  // |w| <= |theta'|
  bounds.turn = std::max(bounds.turn, widen * rate * (first(theta_, m).norm() + d * second_theta_));
}

void MotionPiece::add_changes(double from, double to, MotionBounds& bounds) const {
  const double s0 = share(std::max(from, start_)), s1 = share(std::min(to, end_));
  const double m = 0.5 * (s0 + s1), d = 0.5 * (s1 - s0), rate = 1 / half_;
  const Vec3 a = second(x_, m), spread = d * third_x_ + 1e-12 * second_x_;
  bounds.acceleration.add(Vec3(rate * rate * (a - spread)));
  bounds.acceleration.add(Vec3(rate * rate * (a + spread)));
  // |w'| <= |theta''| + |theta'| |theta x theta'|/6, as between the steps of groups
  const double turn = first(theta_, m).norm() + d * second_theta_;
  const double change = second(theta_, m).norm() + d * third_theta_ + turn * cross_theta_ / 6;
  bounds.turn_change = std::max(bounds.turn_change, rate * rate * (change + 1e-12 * second_theta_));
}

}  // namespace tw
