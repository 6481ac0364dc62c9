// Springs and holds: derivatives against differences, what they keep and what they lose.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/bond.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "math/rotation-vector.h"

namespace tw {
namespace {

class Bonds : public testing::Test {
 protected:
  Vec3 draw(double most) {
    const double x = random_.real(-most, most), y = random_.real(-most, most);
    return {x, y, random_.real(-most, most)};
  }
  PoseTwist draw_body() { return {draw(2), short_rotation(draw(1.5)), draw(1), draw(2)}; }
  // Of each kind in turn: a spring with a length, one without, a hold.
  Bond draw_bond(int kind) {
    Bond bond;
    bond.a = 1;
    bond.b = 2;
    bond.arm_a = draw(0.5);
    bond.arm_b = draw(0.5);
    bond.spring = {30, 2, kind == 0 ? 0.7 : 0.0};
    bond.holds = kind == 2;
    if (bond.holds) bond.turn = {5, 0.4, short_rotation(draw(1.5))};
    // a part of the draws is beyond the limit, a part below where it begins
    if (bond.holds) bond.firm = bond.firm_turn = {2, 10};
    return bond;
  }
  Random random_{11};
};

// What moves a body a little along one of its twelve ways.
PoseTwist moved(PoseTwist body, int way, double step) {
  const Vec3 change = step * Vec3::Unit(way % 3);
  if (way < 3) body.x += change;
  if (way >= 3 && way < 6) body.q = short_rotation(change) * body.q;
  if (way >= 6 && way < 9) body.v += change;
  if (way >= 9) body.w += change;
  return body;
}

Vec6 words(const Wrench& wrench) {
  Vec6 all;
  all << wrench.force, wrench.torque;
  return all;
}

TEST_F(Bonds, derivatives_are_those_of_the_wrenches) {
  for (int i = 0; i < 60; ++i) {
    const Bond bond = draw_bond(i % 3);
    const PoseTwist bodies[2] = {draw_body(), draw_body()};
    const Bond::Derivative exact = bond.derivative(bodies[0], bodies[1]);
    for (const int by : {0, 1})
      for (int way = 0; way < 12; ++way) {
        constexpr double step = 1e-5;
        Vec6 difference[2] = {Vec6::Zero(), Vec6::Zero()};
        for (const double side : {-1.0, 1.0}) {
          PoseTwist both[2] = {bodies[0], bodies[1]};
          both[by] = moved(both[by], way, side * step);
          const Bond::Wrenches w = bond.wrenches(both[0], both[1]);
          difference[0] += side / (2 * step) * words(w.a);
          difference[1] += side / (2 * step) * words(w.b);
        }
        for (const int of : {0, 1}) {
          const WrenchDerivative& d = exact.of[of][by];
          const Vec6 column = way < 6 ? d.by_pose.col(way) : d.by_twist.col(way - 6);
          EXPECT_LT((column - difference[of]).norm(), 1e-7 * (1 + column.norm()))
              << "kind " << i % 3 << ", of " << of << " by " << by << ", way " << way;
        }
      }
  }
}

TEST_F(Bonds, momentum_and_angular_momentum_are_kept) {
  for (int i = 0; i < 30; ++i) {
    const Bond bond = draw_bond(i % 3);
    const PoseTwist a = draw_body(), b = draw_body();
    const Bond::Wrenches w = bond.wrenches(a, b);
    EXPECT_LT((w.a.force + w.b.force).norm(), 1e-13);
    const Vec3 moments = a.x.cross(w.a.force) + w.a.torque + b.x.cross(w.b.force) + w.b.torque;
    EXPECT_LT(moments.norm(), 1e-12);
  }
}

// The power on both bodies is what the store loses, and less by damping.
TEST_F(Bonds, energy_is_stored_or_lost) {
  for (int i = 0; i < 60; ++i) {
    Bond bond = draw_bond(i % 3);
    const bool damped = i % 2;
    if (!damped) bond.spring.damping = bond.turn.damping = 0;
    const PoseTwist a = draw_body(), b = draw_body();
    const Bond::Wrenches w = bond.wrenches(a, b);
    const double power =
        w.a.force.dot(a.v) + w.a.torque.dot(a.w) + w.b.force.dot(b.v) + w.b.torque.dot(b.w);
    const auto later = [](PoseTwist body, double time) {
      body.x += time * body.v;
      body.q = short_rotation(time * body.w) * body.q;
      return body;
    };
    constexpr double step = 1e-5;
    const double stored = (bond.energy(later(a, step), later(b, step)) -
                           bond.energy(later(a, -step), later(b, -step))) /
                          (2 * step);
    if (damped)
      EXPECT_LT(power + stored, 1e-9);
    else
      EXPECT_NEAR(power, -stored, 1e-7 * (1 + std::abs(power)));
  }
}

// As it is held nothing pulls.
TEST_F(Bonds, what_is_held_as_it_was_feels_nothing) {
  Bond bond = draw_bond(2);
  PoseTwist a = draw_body(), b = draw_body();
  b.q = a.q * bond.turn.relative;
  b.x = a.x + a.q * bond.arm_a - b.q * bond.arm_b;
  b.w = a.w;
  b.v = a.v + a.w.cross(b.x - a.x);
  const Bond::Wrenches w = bond.wrenches(a, b);
  EXPECT_LT(words(w.a).norm() + words(w.b).norm(), 1e-13);
  EXPECT_LT(bond.energy(a, b), 1e-28);
}

}  // namespace
}  // namespace tw
