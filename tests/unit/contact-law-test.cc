// Constants of the contact law.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/contact-law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tw {
namespace {

TEST(ContactLaw, depth_is_a_quarter_thousandth_of_the_size_and_carries_the_weight) {
  const ContactConstants c = contact_constants({}, 2, 0.4, 9.81, false);
  EXPECT_DOUBLE_EQ(c.depth, 2.5e-4 * 0.4);
  EXPECT_DOUBLE_EQ(c.k * c.depth, 2 * 9.81);
  EXPECT_DOUBLE_EQ(c.hardening, 2 * c.depth);
}

TEST(ContactLaw, damping_gives_half_of_critical_at_the_static_depth) {
  const ContactConstants c = contact_constants({}, 2, 0.4, 9.81, false);
  // N = k d (1 + b d'): damper k d0 b against 2 sqrt(k m)
  EXPECT_NEAR(c.k * c.depth * c.b / (2 * std::sqrt(c.k * 2)), 0.5, 1e-14);
  EXPECT_NEAR(c.ct / (2 * std::sqrt(c.kt * 2)), 0.5, 1e-14);
  EXPECT_DOUBLE_EQ(c.kt, 0.8 * c.k);
}

TEST(ContactLaw, unequal_masses_make_it_five_times_as_stiff_and_harden_at_the_static_depth) {
  const ContactConstants c = contact_constants({}, 2, 0.4, 9.81, false);
  const ContactConstants u = contact_constants({}, 2, 0.4, 9.81, true);
  EXPECT_NEAR(u.k / c.k, 5, 1e-13);
  EXPECT_DOUBLE_EQ(u.hardening, u.depth);
}

TEST(ContactLaw, given_stiffness_and_damping_hold) {
  ContactParameters parameters;
  parameters.stiffness = 1e5;
  parameters.damping = 0.25;
  parameters.friction = 0.7;
  parameters.friction_law = FrictionLaw::smooth;
  const ContactConstants c = contact_constants(parameters, 2, 0.4, 9.81, true);
  EXPECT_EQ(c.k, 1e5);
  EXPECT_EQ(c.b, 0.25);
  EXPECT_EQ(c.mu, 0.7);
  EXPECT_EQ(c.law, FrictionLaw::smooth);
  EXPECT_DOUBLE_EQ(c.depth, 2 * 9.81 / 1e5);
}

TEST(ContactLaw, four_million_weights_press_a_hundredth_deep) {
  for (const bool unequal : {false, true}) {
    const ContactConstants c = contact_constants({}, 2, 0.4, 9.81, unequal);
    const double weight = 2 * 9.81, depth = 0.01 * 0.4;
    EXPECT_NEAR(spring_force(c, 1, depth) / weight, 4e6, 3e4) << unequal;
    EXPECT_LT(spring_depth(c, 1, 1e6 * weight), 0.9 * depth);
    EXPECT_NEAR(spring_depth(c, 1, 8e6 * weight), 2 * depth, 0.02 * depth);
  }
}

TEST(ContactLaw, without_gravity_the_standard_one_stands_in) {
  const ContactConstants zero = contact_constants({}, 2, 0.4, 0, false);
  const ContactConstants standard = contact_constants({}, 2, 0.4, 9.81, false);
  EXPECT_EQ(zero.k, standard.k);
  EXPECT_EQ(zero.b, standard.b);
}

// To beyond where it hardens no more, ten hardening depths, and the limit of the second hardening,
// twenty.
TEST(ContactLaw, depth_of_a_force_is_the_inverse_of_the_force_and_the_energy_its_integral) {
  ContactConstants c = contact_constants({}, 2, 0.4, 9.81, false);
  for (const double ratio : {1e-9, 0.01, 0.5, 1.0, 3.0, 9.9, 10.1, 12.1, 15.0, 19.9, 20.1, 40.0}) {
    const double depth = ratio * c.hardening, step = 1e-5 * depth;
    const double force = spring_force(c, 0.25, depth);
    EXPECT_NEAR(spring_depth(c, 0.25, force), depth, 1e-14 * depth) << ratio;
    const double slope =
        (spring_energy(c, 0.25, depth + step) - spring_energy(c, 0.25, depth - step)) / (2 * step);
    EXPECT_NEAR(slope, force, 1e-6 * force) << ratio;
  }
  EXPECT_EQ(spring_depth(c, 1, 0), 0);
  EXPECT_EQ(spring_force(c, 1, -1e-3), 0);
  EXPECT_EQ(spring_energy(c, 1, -1e-3), 0);
}

// Tangential springs are kt at the surface, and keep their share of the normal one as it hardens.
TEST(ContactLaw, grip_is_the_root_of_how_much_harder_the_spring_is) {
  const ContactConstants c = contact_constants({}, 2, 0.4, 9.81, false);
  EXPECT_EQ(friction_grip(c, -1e-3), 1);
  EXPECT_EQ(friction_grip(c, 0), 1);
  EXPECT_DOUBLE_EQ(friction_grip(c, c.hardening), std::sqrt(2));
  for (const double ratio : {0.3, 3.0, 9.9, 10.1}) {
    const double depth = ratio * c.hardening, y = friction_grip(c, depth);
    EXPECT_NEAR(y * y, spring_force(c, 1, depth) / (c.k * depth), 1e-12 * y * y) << ratio;
  }
  // of the second hardening they keep up with how steep it is
  for (const double ratio : {13.0, 15.0, 19.0}) {
    const double depth = ratio * c.hardening, step = 1e-6 * depth, y = friction_grip(c, depth);
    const double rise = spring_force(c, 1, depth + step) - spring_force(c, 1, depth - step);
    EXPECT_NEAR(y * y, rise / (2 * step * c.k), 1e-6 * y * y) << ratio;
  }
}

}  // namespace
}  // namespace tw
