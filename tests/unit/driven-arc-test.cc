// Driven arcs: bounds hold, the answer does not depend on who asks, methods agree; force laws have
// the derivatives that they tell.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/explicit/driven-arc.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "integrate/given/keyframes.h"
#include "integrate/standing.h"
#include "support/anchored-spring.h"

namespace tw {
namespace {

TrajectoryPtr swinging_anchor() {
  return make_keyframes({{0, {0, 0, 2}, {}}, {1, {1, 0, 2}, {}}, {2, {0, 1, 2}, {}}}, true);
}

ForcesPtr all_forces() {
  ForcesPtr forces = with_torque(nullptr, {0.02, 0, -0.03});
  forces = with_law(forces, make_drag(0.2, 0.1));
  forces = with_law(forces,
                    test::spring_to(swinging_anchor(), {0.1, 0, 0}, {0.2, 0, 0.1}, {30, 0.5, 0.8}));
  return with_law(forces, test::spring_to({0, 1, 0}, {0, -0.2, 0}, {12, 0.1, 0}));
}

// A tumbling brick on springs in the wind.
DrivenStart brick(double accuracy) {
  DrivenStart start;
  start.time = 0.25;
  start.mass = 2;
  start.moments = {0.02, 0.05, 0.06};
  start.size = 0.3;
  start.gravity = 9.81;
  start.accuracy = accuracy;
  start.x = {1, 2, 3};
  start.v = {1, -2, 0.5};
  start.L = {0.1, 0.2, -0.1};
  start.acceleration = {0, 0, -9.81};
  start.forces = all_forces();
  return start;
}

TEST(DrivenArc, bounds_hold_over_any_stretch) {
  const DrivenArc arc(brick(1e-6));
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const double from = random.real(0.25, 3);
    const double to = from + std::pow(10.0, random.real(-7, 0));
    const MotionBounds bounds = arc.bounds(from, to);
    EXPECT_FALSE(bounds.velocity_may_jump());
    for (int k = 0; k <= 40; ++k) {
      const double t = k == 40 ? to : from + (to - from) * k / 40;
      const PoseTwist p = arc.path_at(t);
      EXPECT_TRUE((p.x.array() >= bounds.path.lo.array()).all() &&
                  (p.x.array() <= bounds.path.hi.array()).all());
      EXPECT_LE(p.v.norm(), bounds.speed);
      EXPECT_LE(p.w.norm(), bounds.turn);
    }
    // changes of velocity over the stretch
    const PoseTwist a = arc.path_at(from), b = arc.path_at(to);
    const double s = to - from;
    const Vec3 dv = b.v - a.v;
    EXPECT_TRUE((dv.array() >= s * bounds.acceleration.lo.array() - 1e-12).all() &&
                (dv.array() <= s * bounds.acceleration.hi.array() + 1e-12).all());
    EXPECT_LE((b.w - a.w).norm(), s * bounds.turn_change + 1e-12);
  }
}

// And are no wider than they need be: within a step they are as wide as what it does.
TEST(DrivenArc, bounds_are_tight_within_a_step) {
  const DrivenArc arc(brick(1e-6));
  const double from = arc.step_end(1), to = from + 1e-4;
  const MotionBounds bounds = arc.bounds(from, to);
  EXPECT_LT(bounds.speed, 1.01 * arc.twist(from).v.norm());
  EXPECT_LT(bounds.turn, 1.01 * arc.twist(from).w.norm());
  EXPECT_LT(bounds.acceleration.size().norm(), 0.1 * bounds.acceleration.center().norm());
}

TEST(DrivenArc, does_not_depend_on_who_asks) {
  const DrivenArc at_once(brick(1e-7)), piecewise(brick(1e-7));
  static_cast<void>(at_once.pose(4));
  for (double t = 0.25; t < 4; t += 0.013) static_cast<void>(piecewise.bounds(t, t + 0.002));
  for (double t = 4; t > 0.25; t -= 0.17) {
    const PoseTwist a = at_once.at(t), b = piecewise.at(t);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
    EXPECT_EQ(a.w, b.w);
  }
}

// The motion itself multiplies errors by up to three.
TEST(DrivenArc, methods_agree_to_their_accuracy) {
  const DrivenArc exact(brick(1e-11));
  DrivenStart paper = brick(1e-6);
  paper.method = &cash_karp;
  const DrivenArc loose(brick(1e-4)), usual(brick(1e-6)), by_paper(paper);
  for (double t = 0.3; t < 3; t += 0.1) {
    EXPECT_LT((loose.pose(t).p - exact.pose(t).p).norm(), 3e-4 * 0.3) << t;
    EXPECT_LT((usual.pose(t).p - exact.pose(t).p).norm(), 3e-6 * 0.3) << t;
    EXPECT_LT((by_paper.pose(t).p - exact.pose(t).p).norm(), 3e-6 * 0.3) << t;
    EXPECT_LT((usual.at(t).v - usual.twist(t).v).norm(), 1e-5) << t;
  }
}

TEST(DrivenArc, ends_where_it_cannot_be_followed) {
  class Explosive final : public ForceLaw {
   public:
    void add(double, const PoseTwist& body, Wrench& sum) const override {
      sum.force += 2 * body.v.squaredNorm() * Vec3::UnitX();
    }
    void add_derivative(double, const PoseTwist&, WrenchDerivative&) const override {}
    std::uint64_t hash() const override { return 0; }
  };
  DrivenStart start;
  start.mass = 2;
  start.accuracy = 1e-6;
  start.v = {1, 0, 0};
  start.name = "rocket";
  start.forces = with_law(nullptr, std::make_shared<Explosive>());
  const DrivenArc arc(start);
  EXPECT_EQ(arc.end(), never);
  static_cast<void>(arc.pose(0.5));
  EXPECT_EQ(arc.end(), never) << "nobody looked so far";
  const Vec3 last = arc.pose(2).p;
  EXPECT_NEAR(arc.end(), 1, 1e-6);
  EXPECT_EQ(arc.pose(3).p, last);
  ASSERT_TRUE(arc.failure());
  try {
    std::rethrow_exception(arc.failure());
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("motion of rocket cannot be followed beyond 1"),
              std::string::npos)
        << error.what();
  }
}

TEST(Forces, derivatives_are_those_of_the_laws) {
  Random random(8);
  const auto draw = [&](double most) {
    const double x = random.real(-most, most), y = random.real(-most, most);
    return Vec3(x, y, random.real(-most, most));
  };
  const ForceLawPtr laws[] = {
      make_drag(0.7, 0.4),
      test::spring_to(swinging_anchor(), {0.1, 0, 0}, {0.2, 0.1, 0.1}, {30, 2, 0.8}),
      test::spring_to({0, 1, 0}, {0, -0.2, 0.3}, {12, 3, 0})};
  for (int i = 0; i < 60; ++i) {
    PoseTwist body;
    body.x = draw(2);
    body.q = rotation_by(draw(3));
    body.v = draw(1);
    body.w = draw(2);
    const ForceLaw& law = *laws[i % 3];
    WrenchDerivative exact, differences;
    law.add_derivative(0.4, body, exact);
    add_differences(law, 0.4, body, 1, 1, differences);
    EXPECT_LT((exact.by_pose - differences.by_pose).norm(), 1e-6 * (1 + exact.by_pose.norm()));
    EXPECT_LT((exact.by_twist - differences.by_twist).norm(), 1e-6 * (1 + exact.by_twist.norm()));
  }
}

}  // namespace
}  // namespace tw
