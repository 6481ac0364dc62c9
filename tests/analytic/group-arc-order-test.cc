// The order of the integrator: errors fall with the fourth power of the step on motions without
// switching. SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic/group-arc-scenes.h"
#include "integrate/free-rotation.h"

namespace tw {
namespace {

using namespace group_scenes;

// A floor that shakes and tilts.
class Shake : public Trajectory {
 public:
  Pose pose(double t) const override {
    return {Vec3(0.02 * std::sin(9 * t), 0, 0.002 * std::sin(7 * t)),
            rotation_by(Vec3(0, 0.1 * std::sin(5 * t), 0))};
  }
  Twist twist(double t) const override {
    return {Vec3(0.18 * std::cos(9 * t), 0, 0.014 * std::cos(7 * t)),
            Vec3(0, 0.5 * std::cos(5 * t), 0)};
  }
  MotionBounds bounds(double, double to) const override {
    MotionBounds bounds;
    bounds.path = bounds.acceleration = Aabb::everywhere();
    bounds.speed = 0.2;
    bounds.turn = 0.5;
    bounds.valid_until = to;
    return bounds;
  }
};

// One arc a step, its state handed to the next.
GroupStart run_with_fixed_steps(GroupStart start, int steps) {
  const double h = start.end / steps;
  start.position_tolerance = start.velocity_tolerance = 1e30;
  for (int i = 0; i < steps; ++i) {
    start.time = i * h;
    start.end = (i + 1) * h;
    start.first_step = 2 * h;
    CompleteArc arc(start);
    arc.extend(start.end);
    EXPECT_EQ(arc.counts().steps, 1u);
    for (std::size_t k = 0; k < start.members.size(); ++k) {
      const GroupSample s = arc.evaluate(static_cast<int>(k), start.end);
      GroupMember& m = start.members[k];
      m.x = s.x;
      m.q = s.q;
      m.v = s.v;
      m.L = s.L;
    }
    for (std::size_t k = 0; k < start.contacts.size(); ++k) {
      start.contacts[k].stretch = arc.stretch(static_cast<int>(k), start.end);
      start.contacts[k].bend = arc.bend(static_cast<int>(k), start.end);
    }
  }
  return start;
}

double difference(const GroupStart& x, const GroupStart& y) {
  double largest = 0;
  for (std::size_t k = 0; k < x.members.size(); ++k) {
    largest = std::max(largest, (x.members[k].x - y.members[k].x).norm());
    largest = std::max(largest, (x.members[k].q.coeffs() - y.members[k].q.coeffs()).norm());
    largest = std::max(largest, (x.members[k].v - y.members[k].v).norm());
  }
  return largest;
}

// Of the errors at `steps` and twice as many, against eight times as many.
double observed_order(const GroupStart& start, int steps) {
  const GroupStart exact = run_with_fixed_steps(start, 8 * steps);
  const double coarse = difference(run_with_fixed_steps(start, steps), exact);
  const double fine = difference(run_with_fixed_steps(start, 2 * steps), exact);
  return std::log2(coarse / fine);
}

// An egg-like ball that rolls and wobbles on the floor, loaded all the time, sticking.
GroupStart wobbling_ball(bool shaken) {
  GroupStart start = on_the_ground(0.4);
  if (shaken) start.outside = {std::make_shared<Shake>()};
  ContactConstants c = constants(1, 0.2, 50);
  c.k = 2000;
  c.kt = 1600;
  c.ct = 30;
  c.hardening = 0.01;
  c.firm = {};
  c.b = 0.3;
  GroupMember m = ball(1, 0.1, Vec3::Zero(), slope_gravity(0.1));
  m.moments = Vec3(0.004, 0.005, 0.003);
  m.L = Vec3(0.003, 0.002, 0.001);
  m.q = rotation_by(Vec3(0.3, 0.2, 0.1));
  const Vec3 core(0.01, 0.02, 0.005);
  m.x = Vec3(0, 0, 0.1 - static_depth(c, g)) - m.q * core;
  start.members = {m};
  add_ball_contact(start, -1, 0, 0.1, c);
  start.contacts[0].point_b = core;
  return start;
}

// A second one rolls on top of it.
GroupStart two_balls(bool shaken, ContactFeature feature, FrictionLaw law) {
  GroupStart start = wobbling_ball(shaken);
  start.end = 0.2;
  GroupContact contact = start.contacts[0];
  GroupMember& below = start.members[0];
  below.x.z() += static_depth(contact.law, g) - static_depth(contact.law, 2 * g);
  const Vec3 n = Vec3(0.05, 0.03, 1).normalized();
  GroupMember above = below;
  above.v = Vec3(0, 0.05, 0);
  above.x = below.x + below.q * contact.point_b + n * (0.2 - static_depth(contact.law, g));
  contact.a = 0;
  contact.b = 1;
  contact.feature = feature;
  contact.radius_a = 0.1;
  contact.point_a = contact.point_b;
  contact.point_b.setZero();
  contact.normal = below.q.conjugate() * n;
  contact.direction = below.q.conjugate() * Vec3(1, 0, -0.05).normalized();
  start.members.push_back(above);
  start.contacts.push_back(contact);
  if (law == FrictionLaw::smooth)
    for (GroupContact& c : start.contacts) {
      c.law.law = law;
      c.law.mu = 1e-3;
    }
  return start;
}

TEST(GroupArcOrder, is_four_for_a_wobbling_ball) {
  EXPECT_NEAR(observed_order(wobbling_ball(false), 40), 4.2, 0.4);
}

TEST(GroupArcOrder, is_four_on_a_shaking_floor) {
  EXPECT_NEAR(observed_order(wobbling_ball(true), 40), 4.2, 0.4);
}

TEST(GroupArcOrder, is_four_for_bodies_rolling_over_each_other) {
  for (const ContactFeature feature : {ContactFeature::point, ContactFeature::line})
    EXPECT_NEAR(observed_order(two_balls(false, feature, FrictionLaw::anchored), 20), 4.2, 0.4);
}

// Both ways that a torque resists: held, as by a spring, and cut to what its lengths allow.
TEST(GroupArcOrder, is_four_where_rolling_and_spinning_are_resisted) {
  for (const double length : {1.0, 1e-5}) {
    GroupStart start = two_balls(true, ContactFeature::point, FrictionLaw::anchored);
    for (GroupContact& c : start.contacts) {
      c.law.size = 0.02;
      c.law.rolling = c.law.spinning = length;
    }
    EXPECT_NEAR(observed_order(start, 20), 4.2, 0.4) << length;
  }
}

TEST(GroupArcOrder, is_four_with_smooth_friction_on_a_shaking_floor) {
  EXPECT_NEAR(observed_order(two_balls(true, ContactFeature::point, FrictionLaw::smooth), 20), 4.2,
              0.4);
}

TEST(GroupArc, a_free_body_tumbles_as_in_closed_form) {
  GroupStart start;
  start.end = 2;
  GroupMember m;
  m.moments = Vec3(1, 2, 3);
  m.L = Vec3(1, 8, 2);
  m.v = Vec3(1, 2, 3);
  start.members = {m};
  const FreeRotation exact(m.moments, m.q, m.L);
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    start.position_tolerance = start.velocity_tolerance = tolerance;
    CompleteArc arc(start);
    for (int i = 0; i <= 200; ++i) {
      const double time = 0.01 * i;
      Quat q;
      Vec3 w;
      exact.evaluate(time, q, w);
      const GroupSample s = arc.evaluate(0, time);
      EXPECT_LT((s.q.coeffs() - q.coeffs()).norm(), 3 * tolerance);
      EXPECT_LT((s.x - m.v * time).norm(), 1e-13);
      EXPECT_LT((s.L - m.L).norm(), 1e-13);
    }
  }
}

// b = 0, mu = 0: kinetic energy, springs and weight together are constant.
TEST(GroupArc, balls_rolling_off_each_other_keep_their_energy) {
  GroupStart start = two_balls(false, ContactFeature::point, FrictionLaw::anchored);
  for (GroupContact& c : start.contacts) {
    c.law.b = 0;
    c.law.mu = 0;
  }
  start.end = 0.3;
  start.position_tolerance = 1e-9;
  start.velocity_tolerance = 1e-8;
  CompleteArc arc(start);
  const auto energy = [&](double time) {
    double sum = arc.elastic_energy(time);
    for (int i = 0; i < 2; ++i) {
      const GroupMember& m = start.members[static_cast<std::size_t>(i)];
      const GroupSample s = arc.evaluate(i, time);
      sum += 0.5 * m.mass * s.v.squaredNorm() + 0.5 * s.w.dot(s.L) - m.force.dot(s.x);
    }
    return sum;
  };
  const double first = energy(0);
  for (int i = 1; i <= 30; ++i) EXPECT_NEAR(energy(0.01 * i), first, 1e-8);
}

}  // namespace
}  // namespace tw
