// Driven motion of single bodies against closed forms: torques, drag, springs.
//
// Errors are held against the accuracy that was asked for, in sizes of the body.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "integrate/given/keyframes.h"
#include "support/scene.h"

namespace tw::test {
namespace {

// A ball of radius 0.5 and density 1 has this mass.
constexpr double radius = 0.5;
const double mass = 4.0 / 3 * pi * radius * radius * radius;
const double moment = 0.4 * mass * radius * radius;

struct Driven {
  World world;
  BodyId ball;

  explicit Driven(double accuracy = 1e-6, const Vec3& gravity = Vec3::Zero(),
                  const Vec3& velocity = Vec3::Zero(), const Vec3& turn = Vec3::Zero()) {
    world.set_accuracy(accuracy);
    world.set_gravity(gravity);
    BodyDef def = body_of(make_sphere(radius), Vec3::Zero(), velocity, turn);
    def.density = 1;
    ball = world.add_body(def);
  }
  Vec3 position(double time) {
    world.advance(time);
    return world.state(ball).position;
  }
};

BodyId add_anchor(World& world, const Vec3& position) {
  BodyDef def;
  def.shape = make_sphere(0.01);
  def.position = position;
  def.fixed = true;
  return world.add_body(def);
}

TEST(DrivenMotion, torque_about_a_principal_axis_turns_evenly_faster) {
  Driven driven;
  const double torque = 0.3;
  driven.world.edit(driven.ball, [&](StateView& v) { v.set_applied_torque({0, 0, torque}); });
  driven.world.advance(3);
  const double alpha = torque / moment, angle = 0.5 * alpha * 9;
  const BodyState s = driven.world.state(driven.ball);
  EXPECT_NEAR(s.angular_velocity.z(), 3 * alpha, 1e-6 * 3 * alpha);
  const Quat exact(std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle));
  EXPECT_LT(2 * (s.orientation * exact.conjugate()).vec().norm(), 1e-6);
  EXPECT_EQ(driven.world.applied_torque(driven.ball).z(), torque);
}

// A couple of constant direction on a sphere that spins across it: L = L0 + T t, w = L/I.
TEST(DrivenMotion, torque_across_a_spin_turns_the_momentum) {
  Driven driven(1e-6, Vec3::Zero(), Vec3::Zero(), {0, 0, 10});
  driven.world.edit(driven.ball, [&](StateView& v) { v.set_applied_torque({0.2, 0, 0}); });
  driven.world.advance(2);
  const Vec3 w = driven.world.state(driven.ball).angular_velocity;
  EXPECT_NEAR(w.x(), 0.4 / moment, 1e-6 * 10);
  EXPECT_NEAR(w.z(), 10, 1e-6 * 10);
}

// A fast symmetric top whose point is held by a stiff force would need a joint; a heavy symmetric
// top on a spring's moment: the steady precession of a spinning disc whose axis a torque turns,
// T = W x L with the torque following by a procedure.
class Following final : public ForceProcedure {
 public:
  explicit Following(double size) : size_(size) {}
  std::uint64_t number() const override { return 1; }
  // as gravity on a top of moment m g l: T = size (axis x up)
  Wrench force(double, const BodyState& body) override {
    return {Vec3::Zero(), size_ * (body.orientation * Vec3::UnitZ()).cross(Vec3::UnitZ()) * -1.0};
  }

 private:
  double size_;
};

// Regular precession at the angle theta: with the spin s about the axis (body) and the rate W about
// the vertical, I1 W^2 cos theta - I3 (s + W cos theta) W + m g l = 0.
TEST(DrivenMotion, heavy_symmetric_top_precesses_regularly) {
  const double I1 = 2, I3 = 1, load = 3, theta = 0.6, W = 1.3;
  const double total = (I1 * W * W * std::cos(theta) + load) / (I3 * W);  // s + W cos theta
  World world;
  world.set_gravity(Vec3::Zero());
  BodyDef def;
  def.mass = 1;
  Mat3 inertia = Mat3::Identity() * I1;
  inertia(2, 2) = I3;
  def.inertia = inertia;
  def.center_of_mass = Vec3::Zero();
  const Quat tilt(std::cos(0.5 * theta), 0, std::sin(0.5 * theta), 0);
  def.orientation = tilt;
  const Vec3 axis = tilt * Vec3::UnitZ();
  def.angular_velocity = Vec3(0, 0, W) + (total - W * std::cos(theta)) * axis;
  const BodyId top = world.add_body(def);
  world.add_force(top, std::make_shared<Following>(load));
  world.advance(5);
  const Vec3 now = world.state(top).orientation * Vec3::UnitZ();
  const Vec3 exact(std::sin(theta) * std::cos(5 * W), std::sin(theta) * std::sin(5 * W),
                   std::cos(theta));
  EXPECT_LT((now - exact).norm(), 1e-6);
}

TEST(DrivenMotion, linear_drag_in_a_throw) {
  const Vec3 g(0, 0, -9.81), v0(4, 0, 6);
  Driven driven(1e-6, g, v0);
  const double c = 0.4, tau = mass / c, t = 2.5;
  driven.world.add_drag(driven.ball, c, 0);
  const double decay = -std::expm1(-t / tau);
  const Vec3 exact = tau * decay * (v0 - g * tau) + g * tau * t;
  EXPECT_LT((driven.position(t) - exact).norm(), 1e-6 * radius);
}

TEST(DrivenMotion, quadratic_drag_in_a_fall) {
  Driven driven(1e-6, {0, 0, -9.81});
  const double c = 0.3, end_speed = std::sqrt(mass * 9.81 / c), t = 4;
  driven.world.add_drag(driven.ball, 0, c);
  const double exact = -end_speed * end_speed / 9.81 * std::log(std::cosh(9.81 * t / end_speed));
  EXPECT_NEAR(driven.position(t).z(), exact, 1e-6 * radius);
  EXPECT_NEAR(driven.world.state(driven.ball).velocity.z(),
              -end_speed * std::tanh(9.81 * t / end_speed), 1e-6 * end_speed);
}

// Along x on a spring of rest length 2 to a fixed point at x = -2.
double oscillator_error(double accuracy, double damping_ratio, double time) {
  Driven driven(accuracy);
  const double k = 7, omega = std::sqrt(k / mass), c = 2 * damping_ratio * std::sqrt(k * mass);
  SpringDef spring;
  spring.a = driven.ball;
  spring.b = add_anchor(driven.world, {-2, 0, 0});
  spring.stiffness = k;
  spring.damping = c;
  driven.world.add_spring(spring);
  driven.world.edit(driven.ball, [](StateView& v) { v.set_velocity({0.6, 0, 0}); });
  const double delta = damping_ratio * omega;
  double exact = 0;
  if (damping_ratio < 1) {
    const double w = omega * std::sqrt(1 - damping_ratio * damping_ratio);
    exact = 0.6 / w * std::exp(-delta * time) * std::sin(w * time);
  } else {
    const double w = omega * std::sqrt(damping_ratio * damping_ratio - 1);
    exact = 0.6 / w * std::exp(-delta * time) * std::sinh(w * time);
  }
  return std::abs(driven.position(time).x() - exact);
}

TEST(DrivenMotion, springs_oscillate_and_creep) {
  EXPECT_LT(oscillator_error(1e-6, 0, 10), 1e-6 * radius);
  EXPECT_LT(oscillator_error(1e-6, 0.1, 10), 1e-6 * radius);
  EXPECT_LT(oscillator_error(1e-6, 1.5, 10), 1e-6 * radius);
}

// The error asked for is the error got, over six decades.
TEST(DrivenMotion, errors_follow_the_accuracy) {
  for (double accuracy = 1e-3; accuracy > 5e-10; accuracy *= 0.1)
    for (const double damping_ratio : {0.0, 0.2})
      EXPECT_LT(oscillator_error(accuracy, damping_ratio, 7.3), accuracy * radius)
          << accuracy << " " << damping_ratio;
}

TEST(DrivenMotion, a_spring_without_damping_keeps_the_energy) {
  Driven driven(1e-6, {0, 0, -9.81}, {1, 2, 0}, {0, 3, 1});
  SpringDef spring;
  spring.a = add_anchor(driven.world, {0, 0, 3});
  spring.b = driven.ball;
  spring.at_b = {0.1, 0.3, 0.2};
  spring.stiffness = 20;
  driven.world.add_spring(spring);
  const double before = driven.world.total_energy();
  driven.world.advance(10);
  EXPECT_NEAR(driven.world.total_energy(), before, 1e-5 * 0.5 * mass * 5);
}

// Turns, at a distance from its anchor, by the spring's moment alone: a pendulum of torsion.
TEST(DrivenMotion, springs_hold_where_they_are_fixed) {
  Driven driven(1e-8);
  SpringDef spring;
  spring.a = driven.ball;
  spring.at_a = {radius, 0, 0};
  spring.b = add_anchor(driven.world, {3, 0, 0});
  spring.stiffness = 5;
  spring.rest = 0;
  driven.world.add_spring(spring);
  SpringDef other = spring;
  other.at_a = {-radius, 0, 0};
  other.b = add_anchor(driven.world, {-3, 0, 0});
  driven.world.add_spring(other);
  driven.world.edit(driven.ball, [](StateView& v) { v.set_angular_velocity({0, 0, 1e-4}); });
  // both hold by k 3 r sin phi to either side
  const double omega = std::sqrt(2 * 5 * 3 * radius / moment), t = 1.1;
  driven.world.advance(t);
  EXPECT_NEAR(driven.world.state(driven.ball).angular_velocity.z(), 1e-4 * std::cos(omega * t),
              1e-8);
}

// Taken along by a body that is moved: x'' = w^2 (a t - x) from rest.
TEST(DrivenMotion, springs_follow_kinematic_bodies) {
  Driven driven;
  BodyDef mover;
  mover.shape = make_sphere(0.01);
  mover.motion = make_keyframes({{0, {0, 0, 2}, {}}, {10, {10, 0, 2}, {}}}, false);
  SpringDef spring;
  spring.a = driven.ball;
  spring.b = driven.world.add_body(mover);
  spring.at_b = {0, 0, -2};
  spring.stiffness = 3;
  spring.rest = 0;
  driven.world.add_spring(spring);
  const double w = std::sqrt(3 / mass), t = 6;
  EXPECT_NEAR(driven.position(t).x(), t - std::sin(w * t) / w, 1e-6 * radius);
}

// Bounces with linear drag: heights follow from the closed form between impacts; here the first
// impact's time and the speed just after.
TEST(DrivenMotion, dragged_balls_meet_the_floor_in_time) {
  Driven driven(1e-6, {0, 0, -9.81});
  const double c = 0.4, tau = mass / c, height = 2;
  driven.world.edit(driven.ball, [&](StateView& v) {
    v.set_pose({0, 0, height + radius}, Quat::Identity());
  });
  add_wall(driven.world, Vec3::UnitZ(), 0);
  set_contact_for_all(driven.world, 0.5, 0);
  driven.world.add_drag(driven.ball, c, 0);
  std::vector<Collision> told;
  driven.world.add_collision_observer([&](const Collision& struck) { told.push_back(struck); });
  driven.world.advance(1);
  // fallen by g tau (t - tau (1 - e^(-t/tau))) = height
  double t = 0.6;
  for (int i = 0; i < 50; ++i) {
    const double decay = -std::expm1(-t / tau);
    t -= (9.81 * tau * (t - tau * decay) - height) / (9.81 * tau * decay);
  }
  const double speed = -9.81 * tau * std::expm1(-t / tau);
  ASSERT_GE(told.size(), 1u);
  EXPECT_NEAR(told[0].time, t, 1e-6 * t);
  EXPECT_NEAR(told[0].speed, speed, 1e-6 * speed);
  const double s = 1 - t;
  const double up = tau * -std::expm1(-s / tau) * (0.5 * speed + 9.81 * tau) - 9.81 * tau * s;
  EXPECT_NEAR(driven.world.state(driven.ball).position.z(), radius + up, 2e-6 * radius);
}

// In a contact group: rolls on a floor with drag at its centre, m (1 + 2/5) v' = -c v.
TEST(DrivenMotion, dragged_balls_roll_out) {
  Driven driven(1e-6, {0, 0, -9.81}, {2, 0, 0}, {0, 2 / radius, 0});
  driven.world.edit(driven.ball, [&](StateView& v) {
    v.set_pose({0, 0, radius}, Quat::Identity());
  });
  add_wall(driven.world, Vec3::UnitZ(), 0);
  const double c = 0.5, tau = 1.4 * mass / c;
  driven.world.add_drag(driven.ball, c, 0);
  driven.world.advance(1);
  const BodyState s = driven.world.state(driven.ball);
  EXPECT_NEAR(s.position.z(), radius, 1e-3 * radius);
  EXPECT_NEAR(s.velocity.x(), 2 * std::exp(-1 / tau), 2e-3);
  EXPECT_NEAR(s.position.x(), 2 * tau * -std::expm1(-1 / tau), 2e-3);
}

// A torque on a ball that lies on the floor rolls it: v' = T / (7/5 m r).
TEST(DrivenMotion, torques_roll_what_lies) {
  Driven driven(1e-6, {0, 0, -9.81});
  driven.world.edit(driven.ball, [&](StateView& v) {
    v.set_pose({0, 0, radius}, Quat::Identity());
    v.set_applied_torque({0, 0.3, 0});
  });
  add_wall(driven.world, Vec3::UnitZ(), 0);
  driven.world.advance(1.5);
  const double a = 0.3 / (1.4 * mass * radius);
  EXPECT_NEAR(driven.world.state(driven.ball).velocity.x(), 1.5 * a, 2e-3 * 1.5 * a);
}

// A force without bound in finite time: named, with time, and the world stays usable.
class Exploding final : public ForceProcedure {
 public:
  std::uint64_t number() const override { return 2; }
  Wrench force(double, const BodyState& body) override {
    return {Vec3(body.velocity.squaredNorm() * mass, 0, 0), Vec3::Zero()};
  }
};

TEST(DrivenMotion, what_runs_away_is_named) {
  Driven driven(1e-6, Vec3::Zero(), {1, 0, 0});
  driven.world.add_force(driven.ball, std::make_shared<Exploding>());
  driven.world.advance(0.5);
  try {
    driven.world.advance(2);
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("body-0"), std::string::npos) << error.what();
  }
  EXPECT_NEAR(driven.world.time(), 1, 1e-3);
}

TEST(DrivenMotion, bad_values_are_errors) {
  Driven driven;
  const BodyId anchor = add_anchor(driven.world, {2, 0, 0});
  EXPECT_THROW(driven.world.add_drag(driven.ball, -1, 0), UserError);
  EXPECT_THROW(driven.world.add_drag(driven.ball, 0, NAN), UserError);
  EXPECT_THROW(driven.world.add_drag(anchor, 1, 0), UserError);
  SpringDef spring;
  spring.a = driven.ball;
  spring.b = anchor;
  spring.stiffness = -1;
  EXPECT_THROW(driven.world.add_spring(spring), UserError);
  spring.stiffness = 1;
  spring.b = driven.ball;
  EXPECT_THROW(driven.world.add_spring(spring), UserError);
  EXPECT_THROW(driven.world.edit(driven.ball,
                                 [](StateView& v) {
                                   v.set_applied_torque({0, 0, NAN});
                                 }),
               UserError);
  EXPECT_EQ(driven.position(1), Vec3(0, 0, 0));
}

// Removing what a spring hangs on ends the spring.
TEST(DrivenMotion, springs_end_with_their_anchors) {
  Driven driven(1e-6, Vec3::Zero(), {1, 0, 0});
  SpringDef spring;
  spring.a = driven.ball;
  spring.b = add_anchor(driven.world, {-2, 0, 0});
  spring.stiffness = 5;
  driven.world.add_spring(spring);
  driven.world.advance(0.3);
  const Vec3 v = driven.world.state(driven.ball).velocity;
  driven.world.remove_body(spring.b);
  driven.world.advance(1);
  EXPECT_EQ(driven.world.state(driven.ball).velocity, v);
}

}  // namespace
}  // namespace tw::test
