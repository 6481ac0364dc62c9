// The motion of a driven body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/driven-arc.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/interruption.h"
#include "integrate/implicit/group-rows.h"
#include "integrate/turning.h"
#include "math/rotation-vector.h"

namespace tw {

using rows::quat;
using rows::vec;

namespace {

// places in y
enum : int { x_row = 0, theta_row = 3, v_row = 6, L_row = 9, numbers = 12 };

Vec3 angular_velocity_of(const Quat& q, const Vec3& inverse_moments, const Vec3& L) {
  const Mat3 R = q.toRotationMatrix();
  return R * inverse_moments.cwiseProduct(R.transpose() * L);
}

ForcesPtr forces_of(const DrivenStart& s) {
  static const ForcesPtr none =
      std::make_shared<ActingForces>(Vec3::Zero(), std::vector<ForceLawPtr>{});
  return s.forces ? s.forces : none;
}

const RungeKutta& method_of(const DrivenStart& s) {
  if (s.method) return *s.method;
  return s.accuracy > answer::loose_accuracy ? tsit5 : dop853;
}

class DrivenEquations final : public Equations {
 public:
  explicit DrivenEquations(const DrivenStart& s)
      : inverse_mass_(1 / s.mass),
        inverse_moments_(s.moments.cwiseInverse()),
        largest_moment_(s.moments.maxCoeff()),
        size_(s.size),
        tolerance_(answer::driven_share * s.accuracy),
        acceleration_(s.acceleration),
        forces_(forces_of(s)),
        slow_speed_(std::sqrt(s.gravity * s.size)),
        slow_turn_(std::sqrt(s.gravity / s.size)),
        longest_(std::min(answer::longest_driven_step / slow_turn_, forces_->longest_unlooked())) {}

  int size() const override { return numbers; }
  int chart_size() const override { return 4; }

  void slope(double time, const double* y, const double* chart, double* slope) const override {
    PoseTwist body;
    const Vec3 theta = vec(y + theta_row);
    body.x = vec(y + x_row);
    body.q = short_rotation(theta) * quat(chart);
    body.v = vec(y + v_row);
    body.w = angular_velocity_of(body.q, inverse_moments_, vec(y + L_row));
    const Wrench wrench = forces_->wrench(time, body);
    vec(slope + x_row) = body.v;
    vec(slope + theta_row) = rotation_vector_rate(theta, body.w);
    vec(slope + v_row) = acceleration_ + inverse_mass_ * wrench.force;
    vec(slope + L_row) = wrench.torque;
  }

  void tolerances(const double* y, const double* chart, double* allowed) const override {
    const Vec3 w = angular_velocity_of(quat(chart), inverse_moments_, vec(y + L_row));
    const double speed = std::max(vec(y + v_row).norm(), slow_speed_);
    const double turn = std::max(w.norm(), slow_turn_);
    for (int i = 0; i < 3; ++i) {
      allowed[x_row + i] = tolerance_ * size_;
      allowed[theta_row + i] = tolerance_;
      allowed[v_row + i] = tolerance_ * speed;
      allowed[L_row + i] = tolerance_ * largest_moment_ * turn;
    }
  }

  // rotation vectors stay well below 2 pi
  double longest_step(const double*, const double* slope, const double*) const override {
    return std::min(longest_, answer::most_driven_turn / vec(slope + theta_row).norm());
  }

  void recentre(double* y, double* slope, double* chart) const override {
    const Vec3 theta = vec(y + theta_row);
    const Quat q = (short_rotation(theta) * quat(chart)).normalized();
    chart[0] = q.w();
    chart[1] = q.x();
    chart[2] = q.y();
    chart[3] = q.z();
    vec(y + theta_row).setZero();
    // theta' = w where theta = 0
    vec(slope + theta_row) = angular_velocity_of(q, inverse_moments_, vec(y + L_row));
  }

 private:
  double inverse_mass_;
  Vec3 inverse_moments_;
  double largest_moment_, size_, tolerance_;
  Vec3 acceleration_;
  ForcesPtr forces_;
  double slow_speed_, slow_turn_, longest_;
};

std::vector<double> starting_row(const DrivenStart& s) {
  std::vector<double> y(numbers, 0.0);
  vec(y.data() + x_row) = s.x;
  vec(y.data() + v_row) = s.v;
  vec(y.data() + L_row) = s.L;
  return y;
}

}  // namespace

DrivenArc::DrivenArc(const DrivenStart& s)
    : mass_(s.mass),
      inverse_moments_(s.moments.cwiseInverse()),
      acceleration_(s.acceleration),
      forces_(forces_of(s)),
      start_{s.x, s.q, s.v, angular_velocity_of(s.q, inverse_moments_, s.L)},
      name_(s.name),
      place_(s.place),
      solution_(method_of(s), std::make_unique<DrivenEquations>(s), s.time, starting_row(s),
                {s.q.w(), s.q.x(), s.q.y(), s.q.z()}) {}

const DenseStep* DrivenArc::step_at(double time, bool beyond) const {
  if (!failure_ && !(time < solution_.reached()) && (beyond || time != solution_.halted())) {
    try {
      solution_.extend(time);
      if (solution_.failure())
        throw UserError("the motion of " + name_ + " cannot be followed beyond " +
                            show(solution_.reached()) + " s: " + solution_.failure() +
                            "; expected forces under which it stays finite",
                        place_);
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      failure_ = std::current_exception();
    }
  }
  // at the end of the last step that end: velocities from the left
  if (failure_ && !(time < solution_.reached())) return nullptr;
  return &solution_.at(time);
}

Quat DrivenArc::attitude(const DenseStep& step, const Vec3& theta) const {
  return short_rotation(theta) * quat(step.chart());
}

Pose DrivenArc::pose(double time) const {
  const DenseStep* step = step_at(time);
  if (!step) {
    if (solution_.reached() == solution_.start()) return {start_.x, start_.q};
    step = &solution_.at(solution_.reached());
    time = solution_.reached();
  }
  return {step->vector(x_row, time), attitude(*step, step->vector(theta_row, time))};
}

Twist DrivenArc::twist(double time) const {
  const DenseStep* step = step_at(time);
  if (!step) return {};
  return {step->vector_rate(x_row, time),
          angular_velocity(step->vector(theta_row, time), step->vector_rate(theta_row, time))};
}

PoseTwist DrivenArc::at(double time) const {
  const DenseStep* step = step_at(time);
  // where it fails it has its velocity still: it may go on from there without the force that failed
  if (!step && time == solution_.reached()) {
    if (time == solution_.start()) return start_;
    step = &solution_.at(time);
  }
  if (!step) {
    const Pose there = pose(time);
    return {there.p, there.q, Vec3::Zero(), Vec3::Zero()};
  }
  const Quat q = attitude(*step, step->vector(theta_row, time));
  return {step->vector(x_row, time), q, step->vector(v_row, time),
          angular_velocity_of(q, inverse_moments_, step->vector(L_row, time))};
}

Vec3 DrivenArc::free_acceleration(double time) const {
  return acceleration_ + forces_->wrench(time, at(time)).force / mass_;
}

void DrivenArc::halt(double time) const {
  if (!failure_) solution_.halt(time);
}

double DrivenArc::end() const { return failure_ ? solution_.reached() : never; }

double DrivenArc::step_end(double time) const {
  return step_at(time, true) ? solution_.step_end(time) : never;
}

Effort DrivenArc::effort() const {
  Effort effort;
  effort.length = solution_.reached() - solution_.start();
  effort.forgotten = solution_.forgotten();
  effort.steps = solution_.counts().steps;
  effort.rejected = solution_.counts().rejected;
  effort.evaluations = solution_.counts().evaluations;
  return effort;
}

void DrivenArc::add_step_bounds(const DenseStep& step, double from, double to,
                                MotionBounds& bounds) const {
  const int degree = step.degree();
  const auto longest = [&](int order, int first) {
    DenseStep::Control points;
    step.control(order, first, from, to, points);
    double squared = 0;
    for (int j = 0; j <= degree - order; ++j) squared = std::max(squared, points[j].squaredNorm());
    return std::sqrt(squared);
  };
  DenseStep::Control points;
  step.control(0, x_row, from, to, points);
  for (int j = 0; j <= degree; ++j) bounds.path.add(points[j]);
  step.control(2, x_row, from, to, points);
  for (int j = 0; j <= degree - 2; ++j) bounds.acceleration.add(points[j]);
  bounds.speed = std::max(bounds.speed, longest(1, x_row));

  // |w| <= |theta'|, |w'| <= |theta''| + |theta'| |theta x theta'|/6
  const double rate = longest(1, theta_row);
  bounds.turn = std::max(bounds.turn, rate);
  bounds.turn_change =
      std::max(bounds.turn_change, longest(2, theta_row) + rate * rate * longest(0, theta_row) / 6);
}

MotionBounds DrivenArc::bounds(double from, double to) const {
  if (!std::isfinite(from) || !std::isfinite(to)) return MotionBounds::unknown();
  MotionBounds bounds;
  step_at(to);
  const double reached = solution_.reached();
  if (!(from < reached)) {
    bounds.path.add(pose(from).p);
    bounds.acceleration.add(Vec3(Vec3::Zero()));
  }
  for (double t = from; t < reached;) {
    const double end = solution_.step_end(t);
    add_step_bounds(solution_.at(t), t, std::min(to, end), bounds);
    t = end;
    if (!(t < to)) break;
  }
  // rounding
  const double largest =
      std::max(bounds.path.lo.cwiseAbs().maxCoeff(), bounds.path.hi.cwiseAbs().maxCoeff());
  bounds.path.grow(1e-15 * largest);
  bounds.acceleration.grow(1e-12 * std::max(bounds.acceleration.lo.cwiseAbs().maxCoeff(),
                                            bounds.acceleration.hi.cwiseAbs().maxCoeff()));
  const double widen = 1 + 1e-12;
  bounds.speed *= widen;
  bounds.turn *= widen;
  bounds.turn_change *= widen;
  bounds.valid_until = to;
  return bounds;
}

double DrivenArc::turn_change_across(const Vec3& n, double from, double to,
                                     const MotionBounds& known) const {
  double most = 0;
  int steps = 0;
  for (double t = from; t < solution_.reached();) {
    if (++steps > cost::turning_steps) return known.turn_change;
    const DenseStep& step = solution_.at(t);
    const double end = solution_.step_end(t), until = std::min(to, end);
    const auto degree = static_cast<std::size_t>(step.degree());
    DenseStep::Control theta, rate, second;
    step.control(0, theta_row, t, until, theta);
    step.control(1, theta_row, t, until, rate);
    step.control(2, theta_row, t, until, second);
    most = std::max(
        most, tw::turn_change_across(n, {theta, degree + 1}, {rate, degree}, {second, degree - 1}));
    t = end;
    if (!(t < to)) break;
  }
  return std::min(known.turn_change, most);
}

}  // namespace tw
