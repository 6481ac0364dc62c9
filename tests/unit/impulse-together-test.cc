// Blows that several take up at once: energy, restitution, friction; slots that are held together.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impulse-solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scene.h"
#include "unit/impulse-energy.h"

namespace tw {
namespace {

using test::energy;
using test::random_vector;

ImpulseSlot random_body(Random& random, double mass) {
  ImpulseSlot slot{random_vector(random, 1), random_vector(random, 1), random_vector(random, 1)};
  slot.inverse_mass = 1 / mass;
  const Vec3 moments = mass * (Vec3::Constant(0.1) + 0.05 * random_vector(random, 1));
  const Mat3 R = test::random_attitude(random).toRotationMatrix();
  slot.inverse_inertia = R * moments.cwiseInverse().asDiagonal() * R.transpose();
  slot.answer = Answer::free;
  return slot;
}

// Bodies of masses up to a thousand times each other's on the ground, struck at the first contact;
// all others carry and are at rest.
TEST(ImpulseTogether, gives_no_energy_and_keeps_the_restitution) {
  Random random(4);
  int blows = 0, rough = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    ImpulseSolver solver;
    const int bodies = 1 + trial % 4;
    const std::uint32_t ground = solver.add({});
    for (int i = 0; i < bodies; ++i) {
      ImpulseSlot slot = random_body(random, std::pow(10, random.real(-1.5, 1.5)));
      slot.v = slot.w = Vec3::Zero();
      solver.add(slot);
    }
    const std::uint32_t hammer = solver.add(random_body(random, 1));
    std::vector<ImpulseContact> contacts;
    const double mu = trial % 3 == 0 ? 0 : random.real(0, 1), e = random.real(0, 1);
    const auto touch = [&](std::uint32_t a, std::uint32_t b) {
      ImpulseContact c;
      c.a = a, c.b = b, c.friction = mu;
      c.point = 0.5 * (solver.slot(a).x + solver.slot(b).x) + random_vector(random, 0.3);
      c.normal = random_vector(random, 1).normalized();
      contacts.push_back(c);
    };
    touch(1, hammer);
    for (int i = 0; i < bodies; ++i)
      for (int k = 0; k < 3; ++k)
        touch(k == 0 && i > 0 ? static_cast<std::uint32_t>(i) : ground,
              static_cast<std::uint32_t>(i + 1));
    const double speed = -solver.approach(contacts[0]);
    if (!(speed > 0.1)) continue;
    const double before = energy(solver);
    ASSERT_TRUE(solver.strike_together(contacts, 1, e)) << trial;
    ++blows;
    EXPECT_LE(energy(solver), before * (1 + 1e-9)) << trial;
    double missed = std::max(0.0, e * speed - solver.approach(contacts[0]));
    for (const ImpulseContact& c : contacts) missed = std::max(missed, -solver.approach(c));
    EXPECT_LE(missed, 0.05 * speed) << trial;  // 2.2 % at most where sweeps have to do
    rough += missed > 1e-6 * speed;
    if (mu == 0 && e == 1) {
      EXPECT_NEAR(energy(solver), before, 1e-9 * before) << trial;
    }
  }
  EXPECT_GT(blows, 500);
  // where Newton's method and sweeps do not come to an end
  EXPECT_LE(rough, blows / 100);
}

// Two that are held answer as the rigid body that they are, whichever way they were joined.
TEST(ImpulseTogether, holds_are_rigid) {
  Random random(9);
  for (int trial = 0; trial < 20; ++trial) {
    ImpulseSolver held, joined;
    std::vector<ImpulseSlot> before;
    for (int i = 0; i < 3; ++i) joined.add(random_body(random, random.real(0.1, 10)));
    const std::vector<std::uint32_t> all = {0, 1, 2};
    const double swinging = energy(joined);
    joined.join_rigidly(all);
    // the whole moves with the momentum of its parts, which have less energy in no other motion
    EXPECT_LE(energy(joined), swinging) << trial;
    for (const std::uint32_t i : all) {
      before.push_back(joined.slot(i));
      before.back().answer = Answer::free;
      held.add(before.back());
    }
    held.hold(0, 1);
    held.hold(1, 2);
    held.hold(2, 0);  // once more than needed
    ImpulseContact c;
    c.a = held.add({}), c.b = 1;
    joined.add({});
    c.point = random_vector(random, 1);
    c.normal = random_vector(random, 1).normalized();
    if (held.approach(c) > 0) c.normal = -c.normal;
    c.restitution = 0.5, c.friction = 0.4;
    held.strike(c);
    joined.strike(c);
    for (const std::uint32_t i : all) {
      EXPECT_LT((held.slot(i).v - joined.slot(i).v).norm(), 1e-9) << trial;
      EXPECT_LT((held.slot(i).w - joined.slot(i).w).norm(), 1e-9) << trial;
    }
    // what each received, holds included, is what changed its momentum
    const std::vector<Vec6> received = held.received();
    for (const std::uint32_t i : all)
      EXPECT_LT((received[i].head<3>() * held.slot(i).inverse_mass - (held.slot(i).v - before[i].v))
                    .norm(),
                1e-9)
          << trial;
  }
}

// What a hold ties to what stands does not give way.
TEST(ImpulseTogether, what_is_held_by_the_ground_stands) {
  Random random(3);
  ImpulseSolver solver;
  const std::uint32_t ground = solver.add({});
  ImpulseSlot slot = random_body(random, 2);
  slot.v = slot.w = Vec3::Zero();
  const std::uint32_t held = solver.add(slot), ball = solver.add(random_body(random, 1));
  solver.hold(ground, held);
  ImpulseContact c;
  c.a = held, c.b = ball;
  c.point = Vec3(0.1, 0.2, 0.3);
  c.normal = -solver.slot(ball).velocity_at(c.point).normalized();
  c.restitution = 0.7;
  const double speed = -solver.approach(c);
  solver.strike(c);
  EXPECT_NEAR(solver.approach(c), 0.7 * speed, 1e-9);
  EXPECT_LT(solver.slot(held).v.norm() + solver.slot(held).w.norm(), 1e-9);
}

}  // namespace
}  // namespace tw
