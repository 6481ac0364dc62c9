// What acts at the joints.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "multibody/joint-laws.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "dynamics/second-hardening.h"
#include "multibody/limits.h"

namespace tw::multibody {
namespace {

// The index of an axis' first coordinate and dof, and its inputs.
struct AxisInputs {
  std::size_t q, u;
  ServoGains servo;
  Stop stop = Stop::none;

  AxisInputs(const Tree& tree, const Inputs& inputs, std::size_t i)
      : q(static_cast<std::size_t>(tree.axes()[i].q)),
        u(static_cast<std::size_t>(tree.axes()[i].u)) {
    if (!inputs.servos.empty()) servo = inputs.servos[i];
    if (!inputs.stops.empty()) stop = inputs.stops[i];
  }
  bool driven() const { return servo.stiffness != 0 || servo.damping != 0; }
};

// -- one coordinate --

// `grip`: 1 where it is as stiff as it gets; 0 where a stop is open, a servo cut.
struct Scalar {
  double torque = 0, by_q = 0, by_u = 0, grip = 0;
};

Scalar passive(const Axis& axis, double q, double u) {
  const AxisSpec& law = axis.law;
  const double v0 = friction_speed(axis);
  const double root = std::sqrt(u * u + v0 * v0);
  return {-law.damping * u - law.friction * u / root - law.stiffness * (q - law.rest),
          -law.stiffness, -law.damping - law.friction * v0 * v0 / (root * root * root), 0};
}

Scalar servo(const AxisInputs& in, const Inputs& inputs, double q, double u) {
  if (!in.driven()) return {};
  const ServoGains& gains = in.servo;
  const double speed = inputs.target_velocities.empty() ? 0 : inputs.target_velocities[in.u];
  const double error = inputs.targets[in.q] - q, error_rate = speed - u;
  const double torque = gains.stiffness * error + gains.damping * error_rate;
  if (torque > gains.max_torque) return {gains.max_torque, 0, 0, 0};
  if (torque < -gains.max_torque) return {-gains.max_torque, 0, 0, 0};
  return {torque, -gains.stiffness, -gains.damping, 1};
}

// A stiffness that was given is all there is.
SecondHardening firm_stop(const Axis& axis) {
  if (axis.law.stop_stiffness) return {};
  return SecondHardening::of(answer::stop_limit * axis.unit, answer::stop_depth * axis.unit);
}

// Of what is limited and its rate; `side` is +1 at the lower limit: the way out.
Scalar stop(const Axis& axis, double side, double q, double u) {
  const double limit = side > 0 ? axis.law.lower : axis.law.upper;
  const double depth = side * (limit - q), rate = -side * u;
  const double k = axis.stop_stiffness, b = stop_damping(axis);
  if (!(depth > 0 && 1 + b * rate > 0)) return {};
  const SecondHardening firm = firm_stop(axis);
  const double hard = k * (1 + firm.hardness(depth));
  const double by_depth = hard + k * depth * firm.slope(depth);
  return {side * hard * depth * (1 + b * rate), -by_depth * (1 + b * rate), -hard * depth * b, 1};
}

Scalar stop(const Axis& axis, const AxisInputs& in, double q, double u) {
  if (in.stop == Stop::none) return {};
  return stop(axis, in.stop == Stop::lower ? 1 : -1, q, u);
}

Scalar scalar_law(const Axis& axis, const AxisInputs& in, const Inputs& inputs, double q,
                  double u) {
  Scalar sum;
  const auto add = [&](const Scalar& s) {
    sum.torque += s.torque, sum.by_q += s.by_q, sum.by_u += s.by_u;
  };
  if (axis.passive) add(passive(axis, q, u));
  if (in.driven()) add(servo(in, inputs, q, u));
  if (in.stop != Stop::none) add(stop(axis, in, q, u));
  return sum;
}

// -- a spherical joint --

struct Ball {
  Vec3 torque = Vec3::Zero();
  Mat3 by_q = Mat3::Zero(), by_u = Mat3::Zero();
  double grip = 0;
};

Quat from_rest(const Quat& rest, const Quat& q) { return rest.conjugate() * q; }

// sin(angle) axis of the quaternion e, and its derivative by a turn z in the link's frame: with
// dw = -v.z/2, dv = (w z + v x z)/2 it is w^2 + w [v]x - v v^T
Vec3 turn(const Quat& e) { return 2 * e.w() * e.vec(); }
Mat3 turn_derivative(const Quat& e) {
  const Vec3 v = e.vec();
  return e.w() * e.w() * Mat3::Identity() + e.w() * cross_matrix(v) - v * v.transpose();
}

Ball passive(const Axis& axis, const Quat& q, const Vec3& u) {
  Ball sum;
  const AxisSpec& law = axis.law;
  const double v0 = friction_speed(axis);
  const double root = std::sqrt(u.squaredNorm() + v0 * v0);
  const Quat e = from_rest(axis.rest_attitude, q);
  sum.torque = -law.damping * u - law.friction / root * u - law.stiffness * turn(e);
  sum.by_q = -law.stiffness * turn_derivative(e);
  sum.by_u = -(law.damping + law.friction / root) * Mat3::Identity() +
             law.friction / (root * root * root) * u * u.transpose();
  return sum;
}

Ball servo(const AxisInputs& in, const Inputs& inputs, const Quat& q, const Vec3& u) {
  Ball sum;
  if (!in.driven()) return sum;
  const Quat e = from_rest(quaternion_at(&inputs.targets[in.q]), q);
  Vec3 speed = Vec3::Zero();
  if (!inputs.target_velocities.empty()) speed = vector_at(&inputs.target_velocities[in.u]);
  const ServoGains& gains = in.servo;
  const Vec3 torque = -gains.stiffness * turn(e) + gains.damping * (speed - u);
  const double length = torque.norm();
  const bool cut = length > gains.max_torque;
  // of what is cut to a length only the part across changes
  const double share = cut ? gains.max_torque / length : 1;
  Mat3 across = share * Mat3::Identity();
  if (cut) across -= share / (length * length) * torque * torque.transpose();
  sum.torque = share * torque;
  sum.by_q = -across * (gains.stiffness * turn_derivative(e));
  sum.by_u = -gains.damping * across;
  sum.grip = cut ? 0 : 1;
  return sum;
}

// Along the direction n of a limited angle, which turns with the joint.
Ball stop(const Axis& axis, const AxisInputs& in, const Quat& q, const Vec3& u) {
  Ball sum;
  if (in.stop == Stop::none) return sum;
  const LimitedAngle at = limited_angle(axis, q);
  const Vec3& n = at.direction;
  const Scalar law_of_angle = stop(axis, -1, at.angle, n.dot(u));
  const Vec3 rate_by_turn = at.direction_by_turn.transpose() * u;
  sum.torque = law_of_angle.torque * n;
  sum.by_q = law_of_angle.by_q * n * n.transpose() + law_of_angle.torque * at.direction_by_turn +
             law_of_angle.by_u * n * rate_by_turn.transpose();
  sum.by_u = law_of_angle.by_u * n * n.transpose();
  sum.grip = law_of_angle.grip;
  return sum;
}

Ball ball_law(const Axis& axis, const AxisInputs& in, const Inputs& inputs, const Quat& q,
              const Vec3& u) {
  Ball sum;
  const auto add = [&](const Ball& s) {
    sum.torque += s.torque, sum.by_q += s.by_q, sum.by_u += s.by_u;
  };
  if (axis.passive) add(passive(axis, q, u));
  if (in.driven()) add(servo(in, inputs, q, u));
  if (in.stop != Stop::none) add(stop(axis, in, q, u));
  return sum;
}

void require_length(std::size_t length, int expected, bool may_be_empty, const char* what) {
  TW_REQUIRE(length == static_cast<std::size_t>(expected) || (may_be_empty && length == 0),
             std::to_string(length) + " " + what + " for a multibody; expected " +
                 std::to_string(expected));
}

void require_finite(In numbers, const Tree& tree, bool positions, const std::string& what) {
  for (const Link& link : tree.links()) {
    const auto begin = static_cast<std::size_t>(positions ? link.q : link.u);
    const auto count = static_cast<std::size_t>(positions ? link.coordinates : link.dofs);
    for (double x : numbers.subspan(begin, count))
      TW_REQUIRE(std::isfinite(x), what + " of the joint of " + link.name + " is " + show(x) +
                                       "; expected a finite number");
  }
}

void require_gain(double value, bool may_be_infinite, const std::string& what) {
  TW_REQUIRE(value >= 0 && (may_be_infinite || std::isfinite(value)),
             what + " is " + show(value) + "; expected a number that is not negative");
}

}  // namespace

double stop_rigidity(const Axis& axis, Stop stop, In q) {
  if (stop == Stop::none) return 0;
  const double at = limited(axis, q);
  const double depth = stop == Stop::lower ? axis.law.lower - at : at - axis.law.upper;
  const SecondHardening firm = firm_stop(axis);
  const double more = firm.hardness(depth) + depth * firm.slope(depth);
  return axis.stop_stiffness * (1 + more);
}

double friction_speed(const Axis& axis) { return answer::joint_friction_speed * axis.slow; }

namespace {

// Adds what is off the tangent where friction lets go.
bool add_unforeseen_friction(const Tree& tree, In from, In to, Out tau) {
  // of x = u/v0: x/r with r^2 = x^2 + 1, and along its tangent x0/r0 + (1 - x0 x0^T/r0^2) dx/r0
  bool any = false;
  const auto add = [&](double friction, const auto& x0, const auto& x1, auto&& torque) {
    if (!(x1.squaredNorm() > x0.squaredNorm())) return;
    any = true;
    const double r0 = std::sqrt(x0.squaredNorm() + 1), r1 = std::sqrt(x1.squaredNorm() + 1);
    const auto dx = (x1 - x0).eval();
    torque -= friction * (x1 / r1 - x0 / r0 - (dx - x0.dot(dx) / (r0 * r0) * x0) / r0);
  };
  for (const Axis& axis : tree.axes()) {
    if (!(axis.law.friction > 0)) continue;
    const auto u = static_cast<std::size_t>(axis.u);
    const double v0 = friction_speed(axis);
    using One = Eigen::Matrix<double, 1, 1>;
    if (axis.ball)
      add(axis.law.friction, Vec3(vector_at(&from[u]) / v0), Vec3(vector_at(&to[u]) / v0),
          Eigen::Map<Vec3>(&tau[u]));
    else
      add(axis.law.friction, One(from[u] / v0), One(to[u] / v0), Eigen::Map<One>(&tau[u]));
  }
  return any;
}

// The same of stops and servos that have lost their grip on the way by z.
bool add_unforeseen_grips(const Tree& tree, const JointMotion& from, const JointMotion& to, In z,
                          const Inputs& inputs, Out tau) {
  if (inputs.servos.empty() && inputs.stops.empty()) return false;
  bool any = false;
  for (std::size_t i = 0; i < tree.axes().size(); ++i) {
    const Axis& axis = tree.axes()[i];
    const AxisInputs in(tree, inputs, i);
    const auto add = [&](const auto& before, const auto& after, const auto& dz, const auto& du,
                         auto&& torque) {
      if (!(after.grip < before.grip)) return;
      any = true;
      torque += after.torque - before.torque - before.by_q * dz - before.by_u * du;
    };
    if (axis.ball) {
      const Quat q0 = quaternion_at(&from.q[in.q]), q1 = quaternion_at(&to.q[in.q]);
      const Vec3 u0 = vector_at(&from.u[in.u]), u1 = vector_at(&to.u[in.u]);
      const Vec3 dz = vector_at(&z[in.u]), du = u1 - u0;
      Eigen::Map<Vec3> torque(&tau[in.u]);
      add(servo(in, inputs, q0, u0), servo(in, inputs, q1, u1), dz, du, torque);
      add(stop(axis, in, q0, u0), stop(axis, in, q1, u1), dz, du, torque);
    } else {
      const double q0 = from.q[in.q], q1 = to.q[in.q], u0 = from.u[in.u], u1 = to.u[in.u];
      const double dz = z[in.u], du = u1 - u0;
      add(servo(in, inputs, q0, u0), servo(in, inputs, q1, u1), dz, du, tau[in.u]);
      add(stop(axis, in, q0, u0), stop(axis, in, q1, u1), dz, du, tau[in.u]);
    }
  }
  return any;
}

}  // namespace

bool unforeseen_torques(const Tree& tree, const JointMotion& from, const JointMotion& to, In z,
                        const Inputs& inputs, Out tau) {
  std::fill(tau.begin(), tau.end(), 0.0);
  const bool lets_go = add_unforeseen_friction(tree, from.u, to.u, tau);
  return add_unforeseen_grips(tree, from, to, z, inputs, tau) || lets_go;
}

double friction_doubt(const Tree& tree, In u, In error) {
  double worst = 0;
  for (const Axis& axis : tree.axes()) {
    if (!(axis.law.friction > 0)) continue;
    const auto at = static_cast<std::size_t>(axis.u);
    const auto size = [&](In of) {
      return axis.ball ? vector_at(&of[at]).norm() : std::abs(of[at]);
    };
    worst = std::max(worst, size(error) / std::max(size(u), friction_speed(axis)));
  }
  return worst;
}

double stop_damping(const Axis& axis) {
  return 1.5 * (1 - axis.law.restitution) / stop_speed(axis);
}

double stop_speed(const Axis& axis) { return answer::stop_speed * axis.slow; }

double stop_tolerance(const Axis& axis, double limit) {
  return answer::stop_tolerance * (axis.unit + std::abs(limit));
}

void require_inputs(const Tree& tree, const Inputs& inputs) {
  require_length(inputs.torques.size(), tree.nv(), true, "torques");
  require_length(inputs.servos.size(), tree.axis_count(), true, "servos");
  require_length(inputs.targets.size(), tree.nq(), inputs.servos.empty(), "targets of servos");
  require_length(inputs.target_velocities.size(), tree.nv(), true, "target velocities");
  require_length(inputs.stops.size(), tree.axis_count(), true, "stops");
  if (!inputs.torques.empty()) require_finite(inputs.torques, tree, false, "torque");
  if (!inputs.targets.empty()) require_finite(inputs.targets, tree, true, "target");
  if (!inputs.target_velocities.empty())
    require_finite(inputs.target_velocities, tree, false, "target velocity");
  for (std::size_t i = 0; i < inputs.servos.size(); ++i) {
    const ServoGains& gains = inputs.servos[i];
    const std::string of = " of the servo of " + tree.link(tree.axes()[i].link).name;
    require_gain(gains.stiffness, false, "stiffness" + of);
    require_gain(gains.damping, false, "damping" + of);
    require_gain(gains.max_torque, true, "greatest torque" + of);
  }
}

void joint_torques(const Tree& tree, In q, In u, const Inputs& inputs, Out tau) {
  if (inputs.torques.empty())
    std::fill(tau.begin(), tau.end(), 0.0);
  else
    std::copy(inputs.torques.begin(), inputs.torques.end(), tau.begin());
  for (std::size_t i = 0; i < tree.axes().size(); ++i) {
    const Axis& axis = tree.axes()[i];
    const AxisInputs in(tree, inputs, i);
    if (!axis.passive && !in.driven() && in.stop == Stop::none) continue;
    if (axis.ball) {
      const Ball law = ball_law(axis, in, inputs, quaternion_at(&q[in.q]), vector_at(&u[in.u]));
      for (int c = 0; c < 3; ++c) tau[in.u + static_cast<std::size_t>(c)] += law.torque[c];
    } else {
      tau[in.u] += scalar_law(axis, in, inputs, q[in.q], u[in.u]).torque;
    }
  }
}

void add_joint_derivatives(const Tree& tree, In q, In u, const Inputs& inputs, Out Kq, Out Ku) {
  const auto n = static_cast<std::size_t>(tree.nv());
  for (std::size_t i = 0; i < tree.axes().size(); ++i) {
    const Axis& axis = tree.axes()[i];
    const AxisInputs in(tree, inputs, i);
    if (!axis.passive && !in.driven() && in.stop == Stop::none) continue;
    if (axis.ball) {
      const Ball law = ball_law(axis, in, inputs, quaternion_at(&q[in.q]), vector_at(&u[in.u]));
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < 3; ++r) {
          const std::size_t at = (in.u + r) + n * (in.u + c);
          Kq[at] += law.by_q(static_cast<int>(r), static_cast<int>(c));
          Ku[at] += law.by_u(static_cast<int>(r), static_cast<int>(c));
        }
    } else {
      const Scalar law = scalar_law(axis, in, inputs, q[in.q], u[in.u]);
      Kq[in.u * (n + 1)] += law.by_q;
      Ku[in.u * (n + 1)] += law.by_u;
    }
  }
}

double spring_energy(const Tree& tree, In q) {
  double sum = 0;
  for (const Axis& axis : tree.axes()) {
    const auto at = static_cast<std::size_t>(axis.q);
    if (axis.ball) {
      // 1 - cos(angle) = 2 |v|^2
      const Quat e = from_rest(axis.rest_attitude, quaternion_at(&q[at]));
      sum += 2 * axis.law.stiffness * e.vec().squaredNorm();
    } else {
      const double stretch = q[at] - axis.law.rest;
      sum += 0.5 * axis.law.stiffness * stretch * stretch;
    }
  }
  return sum;
}

}  // namespace tw::multibody
