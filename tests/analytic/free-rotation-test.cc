// Free rotation: the brick of the cases, an independent integration, closed forms, invariants.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "integrate/free-rotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "taylor-rotation.h"

namespace tw {
namespace {

using reference::TaylorRotation;

// A body in free rotation: moments, attitude, angular velocity in the body.
struct Spin {
  Vec3 moments;
  Quat q;
  Vec3 w_B;

  Vec3 momentum() const { return q * Vec3(moments.cwiseProduct(w_B)); }
  FreeRotation motion() const { return FreeRotation(moments, q, momentum()); }
  TaylorRotation exact() const { return TaylorRotation(moments, q, momentum()); }
};

std::string describe(const Spin& spin) {
  std::ostringstream out;
  out.precision(17);
  out << "moments " << spin.moments.transpose() << " w_B " << spin.w_B.transpose() << " q "
      << spin.q.coeffs().transpose();
  return out.str();
}

Quat tilted() { return Quat(0.3, 0.4, -0.5, 0.7).normalized(); }

double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Vec3 cube() {
    const double x = uniform(-1, 1);
    const double y = uniform(-1, 1);
    const double z = uniform(-1, 1);
    return Vec3(x, y, z);
  }
  Quat attitude() {
    const double w = uniform(-1, 1);
    const Vec3 v = cube();
    return Quat(w, v.x(), v.y(), v.z()).normalized();
  }
  // Moments within a ratio of about e^(2 spread), |w| = speed.
  Spin spin(double spread, double speed) {
    const Vec3 logs = spread * cube();
    const Quat q = attitude();
    const Vec3 w = cube();
    return {logs.array().exp(), q, speed * w.normalized()};
  }

 private:
  std::mt19937_64 engine_;
};

// Spins that together reach every branch: both axes of circulation, both signs, all six orders of
// the moments, both series, and the symmetric bodies.
std::vector<Spin> representative_spins() {
  std::vector<Spin> spins;
  const Vec3 orders[] = {{3, 2, 1}, {3, 1, 2}, {2, 3, 1}, {2, 1, 3}, {1, 3, 2},
                         {1, 2, 3}, {2, 2, 3}, {3, 2, 2}, {2, 1, 2}, {2, 2, 2}};
  const Vec3 velocities[] = {{3, 1, 0.5}, {-3, 1, 0.5}, {0.3, 1, -5}, {0.1, 4, 0.2}, {-1, -2, 2}};
  for (const Vec3& moments : orders)
    for (const Vec3& w : velocities) spins.push_back({moments, tilted(), w});
  return spins;
}

// The numbers of a data file, comments dropped.
std::vector<double> read_numbers(const std::string& name) {
  std::string folder;
#ifdef TW_TEST_DATA_DIR
  folder = TW_TEST_DATA_DIR;
#endif
  if (const char* variable = std::getenv("TW_TEST_DATA")) folder = variable;
  std::ifstream file(folder + "/" + name);
  EXPECT_TRUE(file.good()) << "no file " << folder << "/" << name;
  std::vector<double> numbers;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double x = std::strtod(word.c_str(), &end);
      numbers.push_back(*end == 0 ? x : 0.0);
    }
  }
  return numbers;
}

TEST(FreeRotation, brick_is_right_to_1e_13_after_ten_seconds) {
  const std::vector<double> body = read_numbers("brick.bodies.txt");
  const std::vector<double> exact = read_numbers("brick.exact.txt");
  ASSERT_EQ(body.size(), 24u);
  ASSERT_EQ(exact.size(), 7u);
  const Vec3 moments(body[8], body[9], body[10]);
  const Quat q(body[14], body[15], body[16], body[17]);
  const Vec3 w(body[21], body[22], body[23]);
  const Vec3 w_B = q.conjugate() * w;
  const FreeRotation motion(moments, q, q * Vec3(moments.cwiseProduct(w_B)));
  const Quat expected(exact[3], exact[4], exact[5], exact[6]);
  EXPECT_LT(angle_between(motion.attitude(10), expected), 1e-13);
}

TEST(FreeRotation, agrees_with_taylor_series_in_every_branch) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    TaylorRotation exact = spin.exact();
    for (int i = 1; i <= 4; ++i) {
      exact.advance(0.7L);
      Quat q;
      Vec3 w;
      motion.evaluate(0.7 * i, q, w);
      EXPECT_LT(exact.angle_to(q), 3e-14) << describe(spin);
      const reference::Vec3L u = exact.angular_velocity_B();
      const Vec3 w_B(static_cast<double>(u[0]), static_cast<double>(u[1]),
                     static_cast<double>(u[2]));
      EXPECT_LT((q.conjugate() * w - w_B).norm(), 3e-14 * w_B.norm()) << describe(spin);
    }
  }
}

TEST(FreeRotation, agrees_with_taylor_series_for_random_bodies) {
  Draw draw(1);
  for (int i = 0; i < 150; ++i) {
    const Spin spin = draw.spin(2.0, 5.0);
    TaylorRotation exact = spin.exact();
    exact.advance(2.0L);
    const double error = exact.angle_to(spin.motion().attitude(2.0));
    EXPECT_LT(error, 5e-13) << describe(spin);
  }
}

TEST(FreeRotation, agrees_with_taylor_series_at_negative_times) {
  for (const Spin& spin : representative_spins()) {
    TaylorRotation exact = spin.exact();
    exact.advance(-1.3L);
    EXPECT_LT(exact.angle_to(spin.motion().attitude(-1.3)), 3e-14) << describe(spin);
  }
}

// From a plate or needle to a sphere: the tri-axial formulae alone, with no tolerance.
TEST(FreeRotation, nearly_symmetric_bodies_lose_nothing) {
  for (const double e : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1.5e-15})
    for (const Vec3& moments :
         {Vec3(2, 2 * (1 + e), 3), Vec3(2, 2 * (1 + e), 1), Vec3(2, 2 * (1 + e), 2 * (1 + 2 * e))})
      for (const Vec3& w : {Vec3(1, 2, 3), Vec3(1e-8, -2, 1e-9), Vec3(2, 1e-8, -1e-9),
                            Vec3(1e-9, 1e-10, 2), Vec3(0, 2, -1), Vec3(2, 0, 1e-3)}) {
        const Spin spin{moments, tilted(), w};
        TaylorRotation exact = spin.exact();
        exact.advance(5.0L);
        EXPECT_LT(exact.angle_to(spin.motion().attitude(5)), 5e-14) << describe(spin);
      }
}

// Light axes and separatrices magnify the rounding of the input: that is the yardstick.
// The largest change of attitude when one component of L moves by one unit in the last place.
double effect_of_rounded_input(const Spin& spin, const TaylorRotation& exact, double elapsed) {
  double largest = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Vec3 L = spin.momentum();
    L[i] = std::nextafter(L[i], 1e300);
    TaylorRotation other(spin.moments, spin.q, L);
    other.advance(elapsed);
    largest = std::max(largest, exact.angle_to(other.attitude()));
  }
  return largest;
}

TEST(FreeRotation, extreme_ratios_err_no_more_than_rounded_input) {
  for (const Vec3& moments : {Vec3(1, 999, 1000), Vec3(1, 800, 1000), Vec3(1, 1.5, 1000),
                              Vec3(1000, 1, 30), Vec3(999.9, 1, 1000)})
    for (const Vec3& w : {Vec3(3, 1, 1), Vec3(0.03, 1, 1), Vec3(0.3, 5, 0.1), Vec3(0.1, 0.1, 5)}) {
      const Spin spin{moments, tilted(), w};
      TaylorRotation exact = spin.exact();
      exact.advance(1.0L);
      const double yardstick = effect_of_rounded_input(spin, exact, 1.0);
      EXPECT_LT(exact.angle_to(spin.motion().attitude(1)), 10 * yardstick + 2e-14)
          << describe(spin);
    }
}

TEST(FreeRotation, near_the_separatrix_the_error_is_that_of_rounded_input) {
  // the last is the separatrix itself: w_1 : w_3 = sqrt(I_3 (I_2 - I_3) / (I_1 (I_1 - I_2)))
  for (const Vec3& w : {Vec3(1e-3, 8, -2e-3), Vec3(1e-6, 8, -2e-6), Vec3(-1e-9, 8, 2e-9),
                        Vec3(1, 3, std::sqrt(3.0))}) {
    const Spin spin{{3, 2, 1}, tilted(), w};
    TaylorRotation exact = spin.exact();
    exact.advance(5.0L);
    const double yardstick = effect_of_rounded_input(spin, exact, 5.0);
    EXPECT_LT(exact.angle_to(spin.motion().attitude(5)), 10 * yardstick + 2e-14) << describe(spin);
  }
}

// 0.5 rad/s for 1e4 s: rate and time alone, each rounded once, give 1e-12 rad.
TEST(FreeRotation, ten_thousand_seconds_cost_only_the_rounding_of_the_angle) {
  for (const Vec3& w : {Vec3(0.4, 0.2, 0.1), Vec3(0.05, 0.2, 0.3)}) {
    const Spin spin{{3, 2, 1}, tilted(), w};
    TaylorRotation exact = spin.exact();
    exact.advance(1e4L);
    EXPECT_LT(exact.angle_to(spin.motion().attitude(1e4)), 5e-12) << describe(spin);
  }
}

// |w'| from differences of w: never above the bound, and as high where the body is symmetric.
TEST(FreeRotation, angular_acceleration_stays_within_its_bound) {
  for (const Vec3& moments : {Vec3(3, 2, 1), Vec3(2, 2, 1e-3), Vec3(1, 1, 2), Vec3(3, 2.999, 1)})
    for (const Vec3& w : {Vec3(0.4, 0.2, 0.1), Vec3(0.05, 3, 0.02), Vec3(1, -2, 5)}) {
      const FreeRotation motion = Spin{moments, tilted(), w}.motion();
      const double bound = motion.max_angular_acceleration();
      const double step = 1e-4 / motion.max_angular_speed();
      double most = 0;
      for (int i = 0; i < 400; ++i) {
        Quat q;
        Vec3 before, after;
        motion.evaluate(0.05 * i - step, q, before);
        motion.evaluate(0.05 * i + step, q, after);
        most = std::max(most, (after - before).norm() / (2 * step));
      }
      EXPECT_LE(most, bound * (1 + 1e-6) + 1e-9) << moments.transpose() << ", " << w.transpose();
      const bool symmetric = moments.x() == moments.y();
      EXPECT_GT(most, symmetric ? 0.999 * bound : 0) << moments.transpose();
    }
}

// Steady spin about each axis, the unstable middle one included, either way round.
TEST(FreeRotation, spin_about_a_principal_axis_is_uniform) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double speed : {5.0, -5.0}) {
      const Vec3 w = speed * Vec3::Unit(axis);
      const FreeRotation motion(Vec3(3, 2, 1), Quat::Identity(), Vec3(3, 2, 1).cwiseProduct(w));
      for (const double elapsed : {0.01, 1.0, 60.0, -3.0}) {
        Quat q;
        Vec3 w_W;
        motion.evaluate(elapsed, q, w_W);
        EXPECT_LT(angle_between(q, rotation_by(w * elapsed)), 1e-15 * (1 + 5 * 60));
        EXPECT_EQ(w_W, w);
      }
      EXPECT_EQ(motion.max_angular_speed(), 5.0);
      EXPECT_EQ(motion.max_angular_acceleration(), 0);
    }
}

// Stable axes in any attitude: rounding of R^T L does not grow.
TEST(FreeRotation, spin_about_a_stable_axis_stays_there_in_any_attitude) {
  Draw draw(2);
  for (int i = 0; i < 100; ++i) {
    const Quat q0 = draw.attitude();
    const Eigen::Index axis = i % 2 == 0 ? 0 : 2;
    const Vec3 w = q0 * Vec3(5 * Vec3::Unit(axis));
    const double moment = axis == 0 ? 3 : 1;
    const FreeRotation motion(Vec3(3, 2, 1), q0, moment * w);
    EXPECT_LT(angle_between(motion.attitude(10), rotation_by(w * 10) * q0), 1e-13);
  }
}

TEST(FreeRotation, sphere_turns_uniformly) {
  const Vec3 L(0.3, -4, 2);
  const FreeRotation motion(Vec3(0.4, 0.4, 0.4), tilted(), L);
  const Vec3 w = L / 0.4;
  Quat q;
  Vec3 w_W;
  motion.evaluate(7.5, q, w_W);
  EXPECT_EQ(w_W, w);
  EXPECT_LT(angle_between(q, rotation_by(w * 7.5) * tilted()), 3e-14);
  EXPECT_NEAR(motion.max_angular_speed(), w.norm(), 1e-15 * w.norm());
}

// The symmetric top: precession L/I about L, spin w_a (1 - I_a/I) about the body's axis.
TEST(FreeRotation, symmetric_top_precesses_at_L_over_I) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double along : {0.1, 1.0, 50.0})
      for (const double tilt : {1.0, -1.0, 0.0}) {
        const double across = 2.0;
        Vec3 moments = Vec3::Constant(across);
        moments[axis] = along;
        Vec3 w_B(0.7, -0.4, 0.6);
        w_B[axis] = 3 * tilt;
        const Spin spin{moments, tilted(), w_B};
        const FreeRotation motion = spin.motion();
        for (const double elapsed : {0.3, 4.0, -9.0}) {
          const Vec3 spun = Vec3::Unit(axis) * (w_B[axis] * (1 - along / across) * elapsed);
          const Quat exact =
              rotation_by(spin.momentum() * (elapsed / across)) * tilted() * rotation_by(spun);
          EXPECT_LT(angle_between(motion.attitude(elapsed), exact), 3e-13) << describe(spin);
        }
      }
}

TEST(FreeRotation, no_momentum_is_rest) {
  const FreeRotation motion(Vec3(3, 2, 1), tilted(), Vec3::Zero());
  Quat q;
  Vec3 w;
  motion.evaluate(1e6, q, w);
  EXPECT_EQ(w, Vec3::Zero());
  EXPECT_LT(angle_between(q, tilted()), 3e-16);
  EXPECT_EQ(motion.max_angular_speed(), 0);
}

TEST(FreeRotation, starts_from_the_given_attitude) {
  for (const Spin& spin : representative_spins()) {
    const Quat q = spin.motion().attitude(0);
    EXPECT_LT((q.coeffs() - spin.q.coeffs()).norm(), 5e-16) << describe(spin);
  }
}

TEST(FreeRotation, angular_momentum_and_energy_are_constant_to_rounding) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    const Vec3 L = spin.momentum();
    const double energy = spin.w_B.dot(spin.moments.cwiseProduct(spin.w_B));
    for (const double elapsed : {0.0, 0.1, 3.7, -12.3, 99.0, 1e3, 1e4, -1e4}) {
      Quat q;
      Vec3 w;
      motion.evaluate(elapsed, q, w);
      const Vec3 w_B = q.conjugate() * w;
      const Vec3 L_now = q * Vec3(spin.moments.cwiseProduct(w_B));
      EXPECT_LT((L_now - L).norm(), 4e-15 * L.norm()) << describe(spin);
      EXPECT_LT(std::abs(L_now.norm() - L.norm()), 3e-15 * L.norm()) << describe(spin);
      EXPECT_NEAR(w_B.dot(spin.moments.cwiseProduct(w_B)), energy, 4e-15 * energy)
          << describe(spin);
      EXPECT_NEAR(q.norm(), 1, 4e-16);
    }
  }
}

TEST(FreeRotation, the_velocity_is_the_derivative_of_the_attitude) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    const double h = 1e-4;
    for (const double elapsed : {0.2, 1.9, 8.8}) {
      Quat q;
      Vec3 w;
      motion.evaluate(elapsed, q, w);
      const Quat step = motion.attitude(elapsed + h) * motion.attitude(elapsed - h).conjugate();
      // central difference: error h^2 |w|^3 / 6
      EXPECT_LT((step.vec() / (h * step.w()) - w).norm(), 1e-6) << describe(spin);
    }
  }
}

TEST(FreeRotation, restarting_midway_changes_nothing) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    Quat q;
    Vec3 w;
    for (const double first : {0.4, 2.0, -3.1}) {
      motion.evaluate(first, q, w);
      const Vec3 L = q * Vec3(spin.moments.cwiseProduct(q.conjugate() * w));
      const FreeRotation later(spin.moments, q, L);
      EXPECT_LT(angle_between(later.attitude(1.5), motion.attitude(first + 1.5)), 1e-13)
          << describe(spin);
      // back to the start
      EXPECT_LT(angle_between(later.attitude(-first), spin.q), 1e-13) << describe(spin);
    }
  }
}

TEST(FreeRotation, the_quaternion_is_continuous_with_its_sign) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    const double step = 0.02 / motion.max_angular_speed();
    Quat last = motion.attitude(0);
    for (int i = 1; i < 3000; ++i) {
      const Quat q = motion.attitude(i * step);
      // half of at most 0.02 rad
      ASSERT_LT((q.coeffs() - last.coeffs()).norm(), 0.0101) << describe(spin) << " step " << i;
      last = q;
    }
  }
}

TEST(FreeRotation, the_speed_bound_holds_and_is_reached) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    double largest = 0;
    for (int i = 0; i < 20000; ++i) {
      Quat q;
      Vec3 w;
      motion.evaluate(0.003 * i, q, w);
      largest = std::max(largest, w.norm());
    }
    // a constant speed is its own bound: only the norm's rounding is allowed for
    EXPECT_LE(largest, motion.max_angular_speed() * (1 + 5e-16)) << describe(spin);
    EXPECT_GT(largest, 0.999 * motion.max_angular_speed()) << describe(spin);
  }
}

TEST(FreeRotation, attitude_and_evaluate_give_the_same_bits) {
  for (const Spin& spin : representative_spins()) {
    const FreeRotation motion = spin.motion();
    const FreeRotation copy = motion;
    Quat q;
    Vec3 w;
    copy.evaluate(1.234, q, w);
    EXPECT_EQ(q.coeffs(), motion.attitude(1.234).coeffs()) << describe(spin);
  }
}

TEST(FreeRotation, is_small_enough_to_live_in_every_arc) { EXPECT_LT(sizeof(FreeRotation), 400u); }

// Moments over nine decades, equal or nearly equal pairs, components that vanish or are tiny,
// speeds over a hundred decades: always finite, unit, and of constant momentum and energy.
TEST(FreeRotation, odd_input_never_gives_nan_and_keeps_the_invariants) {
  Draw draw(3);
  for (int i = 0; i < 100000; ++i) {
    Spin spin = draw.spin(i % 3 == 0 ? 10.0 : 1.5, 1.0);
    const double choice = draw.uniform(0, 6);
    if (choice < 1) spin.moments[1] = spin.moments[0];
    if (choice >= 1 && choice < 2)
      spin.moments[2] = spin.moments[0] * (1 + std::pow(10, draw.uniform(-17, -1)));
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double kill = draw.uniform(0, 8);
      if (kill < 1) spin.w_B[k] = 0;
      if (kill > 6.5) spin.w_B[k] *= std::pow(10, draw.uniform(-320, 0));
    }
    if (choice > 5) spin.q = Quat::Identity();
    // numbers that are not normal have no digits to keep: the largest component stays normal
    const double largest = spin.w_B.cwiseAbs().maxCoeff();
    if (largest > 0) spin.w_B /= largest;
    spin.w_B *= std::pow(10, draw.uniform(-50, 50));
    const Vec3 L = spin.momentum();
    const FreeRotation motion = spin.motion();
    const double elapsed = draw.uniform(-1e4, 1e4);
    Quat q;
    Vec3 w;
    motion.evaluate(elapsed, q, w);
    ASSERT_TRUE(is_finite(q) && is_finite(w)) << describe(spin) << " at " << elapsed;
    ASSERT_NEAR(q.norm(), 1, 4e-16) << describe(spin);
    ASSERT_LE(w.stableNorm(), motion.max_angular_speed() * (1 + 2e-15)) << describe(spin);
    // rounding of w along a light axis is magnified by the ratio of moments
    const double ratio = spin.moments.maxCoeff() / spin.moments.minCoeff();
    const Vec3 w_B = q.conjugate() * w;
    const Vec3 L_now = q * Vec3(spin.moments.cwiseProduct(w_B));
    ASSERT_LE((L_now - L).norm(), 5e-15 * ratio * L.norm()) << describe(spin);
    const double energy = spin.w_B.cwiseProduct(spin.moments).dot(spin.w_B);
    ASSERT_LE(std::abs(w_B.cwiseProduct(spin.moments).dot(w_B) - energy), 1e-14 * ratio * energy)
        << describe(spin);
  }
}

TEST(FreeRotation, nan_in_gives_nan_out) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Quat q;
  Vec3 w;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Vec3 bad(3, 2, 1);
    bad[i] = nan;
    FreeRotation(bad, tilted(), Vec3(1, 2, 3)).evaluate(1, q, w);
    EXPECT_FALSE(is_finite(q) && is_finite(w));
    FreeRotation(Vec3(3, 2, 1), tilted(), bad).evaluate(1, q, w);
    EXPECT_FALSE(is_finite(q) || is_finite(w));
  }
  FreeRotation(Vec3(3, 2, 1), tilted(), Vec3(1, 2, 3)).evaluate(nan, q, w);
  EXPECT_FALSE(is_finite(q) || is_finite(w));
}

}  // namespace
}  // namespace tw
