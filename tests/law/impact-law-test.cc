// The impact law alone: 100,000 random frictional impacts, and closed forms.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impact-law.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "support/scene.h"

namespace tw::test {
namespace {

// One body as the contact sees it: masses from 1 g to 1 t, moments of a body that can exist.
Mat3 random_compliance(Random& random) {
  const double mass = std::pow(10.0, random.real(-3, 3)), size = std::pow(10.0, random.real(-1, 1));
  const Vec3 squares = Vec3(random.real(0.01, 1), random.real(0.01, 1), random.real(0.01, 1));
  // I_i = m/3 (sum of the other two squares): a box with these half edges
  const Vec3 moments = mass / 3 * size * size * (squares.sum() * Vec3::Ones() - squares);
  const Mat3 R = random_attitude(random).toRotationMatrix();
  const Mat3 inverse_inertia = R * moments.cwiseInverse().asDiagonal() * R.transpose();
  return contact_compliance(1 / mass, inverse_inertia, size * random_vector(random, 1));
}

TEST(ImpactLaw, never_gains_energy_keeps_to_the_cone_and_ends_the_approach) {
  Random random(1);
  int sliding = 0;
  double worst_gain = 0, worst_cone = 0, worst_approach = 0;
  for (int i = 0; i < 100000; ++i) {
    Mat3 K = random_compliance(random);
    if (random.below(2)) K += random_compliance(random);
    const Vec3 n = random_vector(random, 1).normalized();
    Vec3 u = random_vector(random, 3);
    if (u.dot(n) > 0) u = -u;
    const double e = random.below(4) ? random.real() : static_cast<double>(random.below(2));
    const double mu = random.below(4) ? 2 * random.real() : 0;

    const Vec3 P = impact_impulse(K, n, u, e, mu);
    const Vec3 after = u + K * P;
    // the change of kinetic energy: P.u + P.K P/2
    const double gain = P.dot(u) + 0.5 * P.dot(K * P);
    const double scale = std::abs(P.dot(u)) + 0.5 * P.dot(K * P);
    const double normal = P.dot(n), tangent = (P - normal * n).norm();
    EXPECT_GT(normal, 0);
    worst_gain = std::max(worst_gain, gain / scale);
    worst_cone = std::max(worst_cone, (tangent - mu * normal) / normal);
    worst_approach = std::max(worst_approach, -after.dot(n) / (u.norm() + (K * P).norm()));
    sliding += mu > 0 && tangent > 0.999999 * mu * normal;
    if (mu == 0) {
      EXPECT_NEAR(after.dot(n), -e * u.dot(n), 1e-12 * (K * P).norm());
    }
  }
  EXPECT_LT(worst_gain, 1e-13);
  EXPECT_LT(worst_cone, 1e-11);
  EXPECT_LT(worst_approach, 1e-11);
  EXPECT_GT(sliding, 10000);
  EXPECT_LT(sliding, 90000);
}

// Where the contact sticks, the normal velocity is reversed by e and the rest stops.
TEST(ImpactLaw, sticking_reverses_the_normal_velocity_by_e_and_stops_the_rest) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Mat3 K = random_compliance(random);
    const Vec3 n = random_vector(random, 1).normalized();
    Vec3 u = random_vector(random, 3);
    if (u.dot(n) > 0) u = -u;
    const double e = random.real();
    // P_II alone may pull; then nothing sticks
    if (e * -u.dot(n) / n.dot(K * n) - n.dot(K.inverse() * u) <= 1e-3) continue;
    const Vec3 P = impact_impulse(K, n, u, e, 1e6);
    const Vec3 after = u + K * P;
    const Vec3 bounce = -u.dot(n) / n.dot(K * n) * (K * n);
    // K P_I keeps its tangential part: the law adds e K P_I to rest
    EXPECT_LT((after - e * bounce).norm(), 1e-9 * (u.norm() + (K * P).norm()));
    EXPECT_NEAR(after.dot(n), -e * u.dot(n), 1e-9 * (u.norm() + (K * P).norm()));
  }
}

TEST(ImpactLaw, no_approach_no_impulse) {
  const Mat3 K = Mat3::Identity();
  EXPECT_EQ(impact_impulse(K, Vec3::UnitZ(), {1, 0, 0}, 0.5, 0.5), Vec3::Zero());
  EXPECT_EQ(impact_impulse(K, Vec3::UnitZ(), {1, 0, 2}, 0.5, 0.5), Vec3::Zero());
}

}  // namespace
}  // namespace tw::test
