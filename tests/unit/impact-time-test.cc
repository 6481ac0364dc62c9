// Exact impact times.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "collision/distance/impact-time.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/scene.h"

namespace tw::test {
namespace {

constexpr double no_impact = std::numeric_limits<double>::infinity();

TEST(ImpactTime, spheres_touch_at_the_time_found_and_not_before) {
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const double sum = random.real(0.01, 2);
    const Vec3 r = random.real(sum, 10) * random_vector(random, 1).normalized();
    const Vec3 u = random_vector(random, 3);
    const double found = sphere_sphere_impact(r, u, sum);
    const double nearest = std::max(0.0, -r.dot(u) / u.squaredNorm());
    const double least = (r + nearest * u).norm();
    if (found == no_impact) {
      EXPECT_GE(least, sum * (1 - 1e-12));
      continue;
    }
    ++hits;
    EXPECT_GE(found, 0);
    EXPECT_LE(found, nearest * (1 + 1e-15));
    // an error of time counts with the closing speed
    const Vec3 at = r + found * u;
    EXPECT_NEAR(at.norm(), sum, 2e-15 * (r.norm() + found * u.norm()) * (1 + r.norm() / sum));
  }
  EXPECT_GT(hits, 100);
}

TEST(ImpactTime, of_spheres_at_touch_depends_on_the_direction) {
  EXPECT_EQ(sphere_sphere_impact({1, 0, 0}, {-1, 0, 0}, 1), 0);
  EXPECT_EQ(sphere_sphere_impact({1, 0, 0}, {1, 0, 0}, 1), no_impact);
  EXPECT_EQ(sphere_sphere_impact({1, 0, 0}, {0, 1, 0}, 1), no_impact);
  EXPECT_EQ(sphere_sphere_impact({0.9, 0, 0}, {-1, 0, 0}, 1), 0);
  EXPECT_EQ(sphere_sphere_impact({0.9, 0, 0}, {1, 0, 0}, 1), no_impact);
  EXPECT_EQ(sphere_sphere_impact({2, 0, 0}, {0, 0, 0}, 1), no_impact);
  // a graze is none
  EXPECT_EQ(sphere_sphere_impact({2, 1, 0}, {-1, 0, 0}, 1), no_impact);
}

TEST(ImpactTime, of_very_near_and_distant_spheres) {
  EXPECT_NEAR(sphere_sphere_impact({1e4, 0, 0}, {-1, 0, 0}, 1), 9999, 1e-11);
  EXPECT_NEAR(sphere_sphere_impact({1e9, 0, 0}, {-1, 0, 0}, 1), 1e9 - 1, 1e-6);
  EXPECT_NEAR(sphere_sphere_impact({1e9, 0.6, 0}, {-1, 0, 0}, 1), 1e9 - 0.8, 1e-6);
  EXPECT_NEAR(sphere_sphere_impact({1 + 1e-9, 0, 0}, {-1, 0, 0}, 1), (1 + 1e-9) - 1, 1e-16);
}

TEST(ImpactTime, on_a_plane_is_the_first_crossing_going_down) {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const double gap = random.real(0, 3), speed = random.real(-3, 3);
    const double pull = random.below(3) ? random.real(-10, 10) : 0;
    const double found = sphere_plane_impact(gap, speed, pull);
    const auto height = [&](double s) { return gap + s * (speed + 0.5 * pull * s); };
    const double horizon = found == no_impact ? 10 : found;
    for (int k = 1; k < 50; ++k) EXPECT_GT(height(horizon * k / 50), -1e-13);
    if (found == no_impact) continue;
    EXPECT_NEAR(height(found), 0,
                1e-14 * (gap + std::abs(speed) * found + std::abs(pull) * found * found));
    EXPECT_LE(speed + pull * found, 1e-12);
  }
}

TEST(ImpactTime, on_a_plane_at_touch) {
  EXPECT_EQ(sphere_plane_impact(0, -1, 0), 0);
  EXPECT_EQ(sphere_plane_impact(-0.1, -1, -9.81), 0);
  EXPECT_EQ(sphere_plane_impact(0, 1, 0), no_impact);
  EXPECT_EQ(sphere_plane_impact(0, 0, 0), no_impact);
  EXPECT_EQ(sphere_plane_impact(0, 0, 1), no_impact);
  // at rest and pressed on: now
  EXPECT_EQ(sphere_plane_impact(0, 0, -9.81), 0);
  // thrown up: down again after 2 v/g
  EXPECT_DOUBLE_EQ(sphere_plane_impact(0, 3, -10), 0.6);
}

}  // namespace
}  // namespace tw::test
