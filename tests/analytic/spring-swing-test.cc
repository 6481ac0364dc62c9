// Bodies on springs alone: their explicit steps against a closed form and against RODAS4.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "analytic/group-arc-scenes.h"
#include "dynamics/bond.h"

namespace tw {
namespace {

using namespace group_scenes;

GroupStart floating(double end) {
  GroupStart start = on_the_ground(end);
  start.position_tolerance = 1e-9;
  start.velocity_tolerance = 1e-9 * 300;
  return start;
}

void tie(GroupStart& start, int a, int b, const Vec3& arm_a, const Vec3& arm_b,
         const SpringLaw& law) {
  Bond bond;
  bond.a = static_cast<BodyId>(a);
  bond.b = static_cast<BodyId>(b);
  bond.arm_a = arm_a;
  bond.arm_b = arm_b;
  bond.spring = law;
  start.bonds.push_back({a, b, std::make_shared<Bond>(bond)});
}

// A contact that is never made lets RODAS4 go through the same motion.
GroupStart by_rodas4(GroupStart start) {
  add_ball_contact(start, -1, 0, 0.1, constants(1, 0.2, 0.5));
  start.contacts.back().point_a = Vec3(0, 0, -1000);
  return start;
}

// Two balls of 1 and 3 kg on a spring of rest length 0 that swing 0.1 m against each other while
// both fall.
GroupStart two_balls(double stiffness, double damping, double end) {
  GroupStart start = floating(end);
  const Vec3 gravity(0, 0, -g);
  start.members = {ball(1, 0.02, Vec3::Zero(), gravity), ball(3, 0.02, {0.1, 0, 0}, gravity)};
  tie(start, 0, 1, Vec3::Zero(), Vec3::Zero(), {stiffness, damping, 0});
  return start;
}

TEST(SpringSwing, follows_the_cosine_everywhere_in_few_steps) {
  const double stiffness = 67500, omega = std::sqrt(stiffness * (1 + 1.0 / 3));  // 300 / s
  const double end = 20 * 2 * pi / omega;
  CompleteArc arc(two_balls(stiffness, 0, end));
  double worst = 0, worst_rate = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double time = i * end / 2000;
    const GroupSample a = arc.evaluate(0, time), b = arc.evaluate(1, time);
    worst = std::max(worst, std::abs(b.x.x() - a.x.x() - 0.1 * std::cos(omega * time)));
    worst_rate =
        std::max(worst_rate, std::abs(b.v.x() - a.v.x() + 0.1 * omega * std::sin(omega * time)));
    EXPECT_NEAR(0.25 * a.x.z() + 0.75 * b.x.z(), -0.5 * g * time * time, 1e-12);
  }
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(worst_rate, 1e-7 * omega);
  EXPECT_EQ(arc.counts().factorizations, 0u);
  EXPECT_LT(arc.counts().steps, 20u * 25);
}

// What is kept of it gives bounds, and the same bits in pieces.
TEST(SpringSwing, stays_within_its_bounds_and_is_the_same_in_pieces) {
  const GroupStart start = two_balls(1000, 0.3, 0.5);
  CompleteArc whole(start);
  GroupArc pieces(start);
  for (int i = 0; i < 50; ++i) {
    const double from = i * start.end / 50, to = (i + 1) * start.end / 50;
    pieces.extend(to);
    const MotionBounds bounds = whole.bounds(0, from, to);
    for (int k = 0; k <= 4; ++k) {
      const double time = std::min(from + k * (to - from) / 4, start.end);
      const GroupSample here = whole.evaluate(0, time);
      EXPECT_LE(here.v.norm(), 1.0001 * bounds.speed + 1e-6);
      EXPECT_EQ(here.x, pieces.evaluate(0, time).x);
      EXPECT_EQ(here.v, pieces.evaluate(0, time).v);
    }
  }
  EXPECT_EQ(whole.counts().factorizations, 0u);
}

// A thrown chain of spinning boxes, held at their corners.
TEST(SpringSwing, of_spinning_boxes_is_what_rodas4_makes_of_it) {
  GroupStart start = floating(0.2);
  start.position_tolerance = 1e-8;
  start.velocity_tolerance = 1e-6;
  const Vec3 gravity(0, 0, -g);
  for (int i = 0; i < 4; ++i) {
    GroupMember box = cube(1 + i, 0.2, {0.3 * i, 0.02 * i * i, 0.1 * (i % 2)}, gravity);
    box.moments = box.mass * Vec3(1e-3, 3e-3, 5e-3);
    box.q = rotation_by({0.3 * i, 1.0 - i, 0.2});
    box.v = Vec3(0, i, 1);
    box.L = box.mass * Vec3(0.01, -0.02 * i, 0.03);
    start.members.push_back(box);
    if (i > 0)
      tie(start, i - 1, i, {0.05, 0.04, 0}, {-0.05, 0, 0.03}, {2000, 0.5, i == 2 ? 0.0 : 0.15});
  }
  CompleteArc ours(start), theirs(by_rodas4(start));
  EXPECT_EQ(ours.counts().factorizations, 0u);
  EXPECT_GT(theirs.counts().factorizations, 0u);
  EXPECT_LT(3 * ours.counts().steps, theirs.counts().steps);
  for (int i = 0; i <= 40; ++i)
    for (int m = 0; m < 4; ++m) {
      const GroupSample a = ours.evaluate(m, 0.005 * i), b = theirs.evaluate(m, 0.005 * i);
      EXPECT_LT((a.x - b.x).norm(), 1e-6);
      EXPECT_LT(a.q.angularDistance(b.q), 1e-5);
      EXPECT_LT((a.v - b.v).norm(), 1e-4);
      EXPECT_LT((a.L - b.L).norm(), 1e-5);
    }
}

// What hangs still, or is damped by more than it swings, is left to the method for stiff equations.
TEST(SpringSwing, what_hardly_swings_takes_long_steps) {
  for (const double damping : {0.0, 2000.0}) {
    GroupStart start = two_balls(67500, damping, 1);
    if (damping == 0) start.members[1].x.x() = 1e-9;
    CompleteArc arc(start);
    EXPECT_GT(arc.counts().factorizations, 0u) << damping;
    EXPECT_LT(arc.counts().steps, 200u) << damping;
  }
}

// A stiff strut that nothing makes swing, beside a spring that swings: explicit steps would be as
// short as the strut's own swing, RODAS4's are not.
TEST(SpringSwing, beside_a_stiff_strut_at_rest_is_left_to_rodas4) {
  GroupStart start = two_balls(100, 0, 1);
  start.position_tolerance = 1e-7;
  start.velocity_tolerance = 1e-6;
  start.members.push_back(ball(1, 0.02, {-0.3, 0, 0}, {0, 0, -g}));
  tie(start, 0, 2, Vec3::Zero(), Vec3::Zero(), {1e8, 4000, 0.3});
  CompleteArc ours(start), theirs(by_rodas4(start));
  EXPECT_GT(ours.counts().factorizations, 0u);
  EXPECT_LT(ours.counts().steps, theirs.counts().steps + 100);
  EXPECT_LT(ours.counts().steps, 1000u);
}

// What is damped within the arc is left to the other method from there on.
TEST(SpringSwing, that_dies_away_goes_on_in_long_steps) {
  const double stiffness = 67500;
  CompleteArc arc(two_balls(stiffness, 100, 20));
  EXPECT_GT(arc.counts().factorizations, 0u);
  EXPECT_LT(arc.counts().steps, 600u);
  const GroupSample a = arc.evaluate(0, 20), b = arc.evaluate(1, 20);
  EXPECT_NEAR(b.x.x() - a.x.x(), 0, 1e-7);
  EXPECT_NEAR(0.25 * a.x.z() + 0.75 * b.x.z(), -0.5 * g * 400, 1e-7);
}

}  // namespace
}  // namespace tw
