// The impact laws alone: random frictional impacts, closed forms, and impacts followed by small
// steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "dynamics/impact-law.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "dynamics/stronge-law.h"

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

struct RandomImpact {
  Mat3 K;
  Vec3 n, u;
  double e, mu;
};
RandomImpact random_impact(Random& random) {
  RandomImpact at;
  at.K = random_compliance(random);
  if (random.below(2)) at.K += random_compliance(random);
  at.n = random_vector(random, 1).normalized();
  at.u = random_vector(random, 3);
  if (at.u.dot(at.n) > 0) at.u = -at.u;
  at.e = random.below(4) ? random.real() : static_cast<double>(random.below(2));
  at.mu = random.below(4) ? 2 * random.real() : random.below(2) ? 5 : 0.01;
  return at;
}

TEST(StrongesLaw, never_gains_energy_keeps_to_the_cone_and_ends_the_approach) {
  Random random(3);
  double worst_gain = 0, worst_cone = 0, worst_approach = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto [K, n, u, e, mu] = random_impact(random);
    const Vec3 P = stronge_impulse(K, n, u, e, mu);
    const Vec3 after = u + K * P;
    const double gain = P.dot(u) + 0.5 * P.dot(K * P);
    const double normal = P.dot(n), tangent = (P - normal * n).norm();
    ASSERT_GT(normal, 0);
    worst_gain = std::max(worst_gain, gain / std::abs(P.dot(u)));
    worst_cone = std::max(worst_cone, (tangent - mu * normal) / normal);
    worst_approach = std::max(worst_approach, -after.dot(n) / (u.norm() + (K * P).norm()));
  }
  EXPECT_LT(worst_gain, 1e-13);
  EXPECT_LT(worst_cone, 1e-12);
  EXPECT_LT(worst_approach, 1e-12);
}

// The same impact by some hundred thousand small impulses along n, each with the friction in the
// disc of radius mu that leaves the least energy: Coulomb's, whether it slides or sticks.
Vec3 followed(const RandomImpact& at) {
  const auto& [K, n, u, e, mu] = at;
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = n.unitOrthogonal();
  across.col(1) = n.cross(across.col(0));
  const Eigen::Matrix2d T = across.transpose() * K * across;
  const Eigen::Vector2d c = across.transpose() * (K * n);
  const double dp = -u.dot(n) / n.dot(K * n) / 50000;
  Vec3 v = u, P = Vec3::Zero();
  double work = 0, least = 0;
  for (int i = 0; i < 3000000; ++i) {
    const Eigen::Vector2d s = across.transpose() * v + c * dp;
    Eigen::Vector2d f = -T.inverse() * s;
    if (f.norm() > mu * dp) {
      // (T + l) f = -s, |f| = mu dp
      double low = 0, high = s.norm() / (mu * dp);
      for (int j = 0; j < 50; ++j) {
        const double l = 0.5 * (low + high);
        f = -(T + l * Eigen::Matrix2d::Identity()).inverse() * s;
        (f.norm() > mu * dp ? low : high) = l;
      }
    }
    const Vec3 impulse = n * dp + across * f;
    const Vec3 next = v + K * impulse;
    work += 0.5 * dp * n.dot(v + next);
    v = next;
    P += impulse;
    if (n.dot(v) < 0) least = std::min(least, work);
    if (n.dot(v) >= 0 && work >= (1 - e * e) * least) break;
  }
  return P;
}

TEST(StrongesLaw, is_what_many_small_impulses_come_to) {
  Random random(4);
  for (int i = 0; i < 24; ++i) {
    const RandomImpact at = random_impact(random);
    const Vec3 P = stronge_impulse(at.K, at.n, at.u, at.e, at.mu);
    EXPECT_LT((P - followed(at)).norm(), 1e-4 * P.norm()) << i;
  }
}

// In a plane all is piecewise quadratic.  K and u along x, y, z = n.
TEST(StrongesLaw, sliding_that_stops_in_compression) {
  Mat3 K;
  K << 2, 0, 0.5, 0, 3, 0, 0.5, 0, 1;
  // s' = c - mu T = -1/2: it stops at p = 1/2, with u.n = -5/8; then |c/T| = 1/4 <= mu holds it
  const double to_stop = 0.5, v = -0.625, sticking = 1 - 0.5 * 0.5 / 2;
  const double work = 0.5 * to_stop * (-1 + v) - 0.5 * v * v / sticking;
  for (const double e : {0.0, 0.5, 1.0}) {
    const double p = to_stop - v / sticking + std::sqrt(-2 * e * e * work / sticking);
    const Vec3 expected(-0.5 * to_stop - 0.25 * (p - to_stop), 0, p);
    const Vec3 P = stronge_impulse(K, Vec3::UnitZ(), {0.25, 0, -1}, e, 0.5);
    EXPECT_LT((P - expected).norm(), 1e-12) << e << ": " << P.transpose();
  }
}

TEST(StrongesLaw, sliding_that_turns_back_in_restitution) {
  Mat3 K;
  K << 2, 0, 1.5, 0, 3, 0, 1.5, 0, 2;
  // s' = c + mu T = 5/2: it stops at p = 2/5, after u.n = 0; |c/T| = 3/4 > mu, so it slides back
  const double mu = 0.5, first = 2 + mu * 1.5, second = 2 - mu * 1.5, to_stop = 0.4;
  const double least = -0.5 / first, v = -1 + first * to_stop;
  const double e = 0.9, need = -e * e * least - 0.5 * v * v / first;
  const double back = (-v + std::sqrt(v * v + 2 * second * need)) / second;
  const Vec3 expected(mu * to_stop - mu * back, 0, to_stop + back);
  const Vec3 P = stronge_impulse(K, Vec3::UnitZ(), {-1, 0, -1}, e, mu);
  EXPECT_LT((P - expected).norm(), 1e-12) << P.transpose();
}

// Links may leave K without an answer across the contact.
TEST(StrongesLaw, singular_compliance) {
  const Vec3 a(0.6, 0, 0.8);
  const Mat3 K = a * a.transpose();
  const Vec3 u = -2 * a;
  for (const double mu : {0.1, 1.0, 10.0}) {
    const Vec3 P = stronge_impulse(K, Vec3::UnitZ(), u, 0.5, mu);
    EXPECT_TRUE(P.allFinite()) << mu;
    EXPECT_GE((u + K * P).z(), -1e-12) << mu;
    EXPECT_LE(P.dot(u) + 0.5 * P.dot(K * P), 1e-12) << mu;
  }
}

TEST(ImpactLaw, no_approach_no_impulse) {
  const Mat3 K = Mat3::Identity();
  EXPECT_EQ(impact_impulse(K, Vec3::UnitZ(), {1, 0, 0}, 0.5, 0.5), Vec3::Zero());
  EXPECT_EQ(impact_impulse(K, Vec3::UnitZ(), {1, 0, 2}, 0.5, 0.5), Vec3::Zero());
  EXPECT_EQ(stronge_impulse(K, Vec3::UnitZ(), {1, 0, 2}, 0.5, 0.5), Vec3::Zero());
}

}  // namespace
}  // namespace tw::test
