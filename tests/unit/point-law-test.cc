// The law at one point, against what it says of itself and against the four lanes of group steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/point-law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrate/implicit/contact-pack.h"
#include "integrate/implicit/group-rows.h"
#include "support/dice.h"

namespace tw::test {
namespace {

ContactConstants random_law(Dice& dice, FrictionLaw friction) {
  ContactParameters p;
  p.friction = dice.between(0, 1.2);
  p.friction_law = friction;
  if (dice.coin()) p.rolling_friction = dice.between(0, 0.02);
  if (dice.coin()) p.spinning_friction = dice.between(0, 0.02);
  return contact_constants(p, dice.decades(0.01, 100), dice.decades(0.01, 1), 9.81, dice.coin());
}

// From far apart over what a weight presses to beyond the limit of the law.
double random_depth(Dice& dice, const ContactConstants& law) {
  return dice.coin() ? -dice.decades(1e-4, 1) * law.size
                     : dice.decades(1e-2 * law.depth, 3 * law.firm.limit);
}

void expect_near(const Vec3& x, const Vec3& y, double error, const char* what) {
  EXPECT_LE((x - y).norm(), error) << what;
}

Vec3 lane(const LaneVec& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }

// A pair of bodies with four contacts of the plane kind, anywhere, at the depths of the dice.
struct RandomPack {
  GroupStart start;
  ContactPacks packs;
  BodyKinematics bodies[2];
  PointMotion at[lane_count];
  LaneVec stretch, bend;
  Mat3 Ra;

  RandomPack(Dice& dice, FrictionLaw friction) {
    start.members.resize(2);
    Vec3 x[2], v[2], w[2];
    Mat3 R[2];
    for (int i = 0; i < 2; ++i) {
      x[i] = dice.cube(1), v[i] = dice.cube(2), w[i] = dice.cube(3);
      R[i] = dice.turn().toRotationMatrix();
      rows::vec(bodies[i].x) = x[i];
      rows::vec(bodies[i].v) = v[i];
      rows::vec(bodies[i].w) = w[i];
      rows::store_rotation(R[i], bodies[i].R);
    }
    Ra = R[0];
    const ContactConstants law = random_law(dice, friction);
    for (int i = 0; i < lane_count; ++i) {
      GroupContact c;
      c.a = 0, c.b = 1;
      c.normal = dice.cube(1).normalized();
      c.point_a = dice.cube(0.5);
      c.point_b = dice.cube(0.5);
      c.radius_b = dice.between(0, 0.1);
      c.share = dice.between(0.1, 1);
      c.law = law;
      c.pressed = true;
      const Vec3 n = Ra * c.normal, core = x[1] + R[1] * c.point_b, point = core - c.radius_b * n;
      const double gap = n.dot(core - x[0] - Ra * c.point_a) - c.radius_b;
      PointMotion& motion = at[i];
      motion.depth = random_depth(dice, law);
      c.offset = gap + motion.depth;
      // what comes out of the sum
      motion.depth = c.offset - gap;
      motion.normal = n;
      motion.velocity = v[1] + w[1].cross(point - x[1]) - v[0] - w[0].cross(point - x[0]);
      motion.turning = w[1] - w[0];
      c.stretch = dice.cube(dice.decades(0.01, 100) * law.depth);
      c.bend = dice.cube(dice.decades(0.01, 100) * law.depth / law.size);
      motion.stretch = Ra * c.stretch;
      motion.bend = Ra * c.bend;
      start.contacts.push_back(c);
      for (int axis = 0; axis < 3; ++axis) {
        LaneVec* rows[] = {&stretch, &bend};
        for (int r = 0; r < 2; ++r) {
          Lanes* parts[] = {&rows[r]->x, &rows[r]->y, &rows[r]->z};
          (*parts[axis])[i] = (r == 0 ? c.stretch : c.bend)[axis];
        }
      }
    }
    packs = make_contact_packs(start);
  }
};

void compare(unsigned seed, FrictionLaw friction) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  Dice dice(seed);
  const RandomPack random(dice, friction);
  ASSERT_EQ(random.packs.packs.size(), 1u);
  const ContactPack& pack = random.packs.packs.front();
  PackState state;
  evaluate_pack(pack, random.bodies, random.stretch, random.bend, LaneVec{}, state);
  const Lanes energies = pack_energy(pack, state);
  for (int i = 0; i < pack.count; ++i) {
    SCOPED_TRACE("lane " + std::to_string(i));
    const GroupContact& c = random.start.contacts[static_cast<std::size_t>(pack.contact[i])];
    const PointMotion& at = random.at[pack.contact[i]];
    const PointForce expected = point_force(c.law, c.share, at);
    // lanes have the depth to the rounding of the bodies' places, and forces go by its powers; what
    // is summed may be much larger than the sum
    const double close = 1e-11 + 3e-14 / std::abs(at.depth);
    const double grip = friction_grip(c.law, at.depth), speed = at.velocity.norm();
    const double kt = grip * c.share * c.law.kt, ct = grip * c.share * c.law.ct;
    const double scale = spring_force(c.law, c.share, at.depth) * (1 + c.law.b * speed) +
                         kt * at.stretch.norm() + ct * speed + expected.drag.norm();
    EXPECT_NEAR(state.N[i], expected.normal_force, close * scale);
    expect_near(lane(state.f, i), expected.force(at.normal), close * scale, "force");
    if (c.law.ct > 0)
      expect_near(random.Ra * lane(state.stretch_rate, i), expected.stretch_rate,
                  close * scale / (c.share * c.law.ct), "stretch rate");
    const double turning = scale * c.law.size + expected.torque.norm() +
                           c.law.squared_lever() * (kt * at.bend.norm() + ct * at.turning.norm());
    if (state.turns)
      expect_near(lane(state.torque, i), expected.torque, close * turning, "torque");
    else
      EXPECT_EQ(expected.torque, Vec3::Zero());
    if (pack.bend >= 0)
      expect_near(random.Ra * lane(state.resistance.rate, i), expected.bend_rate,
                  close * turning / pack.resistance.c[i], "bend rate");
    if (friction == FrictionLaw::anchored && state.N[i] > 0) {
      EXPECT_EQ(state.slipping[i] != 0, expected.slips);
    }
    const double energy = point_energy(c.law, c.share, at);
    EXPECT_NEAR(energies[i], energy, close * energy);
  }
}

TEST(PointLaw, four_lanes_do_as_it_says_with_anchored_friction) {
  for (unsigned seed = 1; seed <= 2000; ++seed) compare(seed, FrictionLaw::anchored);
}

TEST(PointLaw, four_lanes_do_as_it_says_with_smooth_friction) {
  for (unsigned seed = 1; seed <= 1000; ++seed) compare(seed, FrictionLaw::smooth);
}

// F.u + kt xi.xi' <= 0 and M.w + K beta.beta' <= 0, whatever the grip is.
TEST(PointLaw, friction_never_gives_what_it_did_not_take) {
  Dice dice(7);
  for (int i = 0; i < 10000; ++i) {
    const ContactConstants law = random_law(dice, FrictionLaw::anchored);
    PointMotion at;
    at.normal = dice.cube(1).normalized();
    at.depth = random_depth(dice, law);
    at.velocity = dice.cube(3);
    at.turning = dice.cube(3);
    const Vec3 stretch = dice.cube(dice.decades(0.01, 100) * law.depth);
    at.stretch = stretch - at.normal.dot(stretch) * at.normal;
    at.bend = dice.cube(dice.decades(0.01, 100) * law.depth / law.size);
    const PointForce f = point_force(law, 1, at);
    const double gives = f.friction.dot(at.velocity) + law.kt * at.stretch.dot(f.stretch_rate);
    EXPECT_LE(gives, 1e-12 * (f.friction.norm() * at.velocity.norm()));
    EXPECT_LE(f.drag.dot(at.velocity), 0);
    const double bent = law.kt * law.squared_lever() * at.bend.dot(f.bend_rate);
    EXPECT_LE(f.torque.dot(at.turning) + bent,
              1e-12 * (f.torque.norm() * at.turning.norm() + std::abs(bent)));
  }
}

// With dE/dd = N at rest.
TEST(PointLaw, its_energy_at_rest_is_the_integral_of_its_force) {
  Dice dice(3);
  for (int i = 0; i < 1000; ++i) {
    const ContactConstants law = random_law(dice, FrictionLaw::anchored);
    PointMotion at;
    at.depth = dice.decades(0.1 * law.depth, 2 * law.firm.limit);
    const double step = 1e-4 * at.depth, force = point_force(law, 0.5, at).normal_force;
    PointMotion more = at, less = at;
    more.depth += step;
    less.depth -= step;
    EXPECT_NEAR((point_energy(law, 0.5, more) - point_energy(law, 0.5, less)) / (2 * step), force,
                1e-5 * force);
  }
}

}  // namespace
}  // namespace tw::test
