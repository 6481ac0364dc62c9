// Explicit methods: orders of steps, of polynomials, of error estimates; control of steps; bounds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "integrate/explicit/solution.h"

namespace tw {
namespace {

// y = 1/(1+t^2), z = exp(sin t), and a circle whose frequency is the square of its radius, 1.
class Known final : public Equations {
 public:
  Known(double step, double allowed) : step_(step), allowed_(allowed) {}
  int size() const override { return 4; }
  void slope(double t, const double* y, const double*, double* to) const override {
    const double s = y[2] * y[2] + y[3] * y[3];
    to[0] = -2 * t * y[0] * y[0];
    to[1] = std::cos(t) * y[1];
    to[2] = -s * y[3];
    to[3] = s * y[2];
  }
  void tolerances(const double*, const double*, double* allowed) const override {
    std::fill(allowed, allowed + 4, allowed_);
  }
  double longest_step(const double*, const double*, const double*) const override { return step_; }
  static std::vector<double> exact(double t) {
    return {1 / (1 + t * t), std::exp(std::sin(t)), std::cos(t), std::sin(t)};
  }

 private:
  double step_, allowed_;
};

constexpr double anything = 1e100;

double error_at(Solution& solution, double time) {
  const std::vector<double> exact = Known::exact(time);
  double error = 0;
  for (int i = 0; i < 4; ++i)
    error = std::max(
        error, std::abs(solution.at(time).value(i, time) - exact[static_cast<std::size_t>(i)]));
  return error;
}

Solution fixed_steps(const RungeKutta& method, double start, double h) {
  return {method, std::make_unique<Known>(h, anything), start, Known::exact(start)};
}

double global_error(const RungeKutta& method, double h) {
  Solution solution = fixed_steps(method, 0.5, h);
  solution.extend(2.5);
  return error_at(solution, 2.5);
}

// of the polynomial of one step, at its worst
double inner_error(const RungeKutta& method, double h) {
  Solution solution = fixed_steps(method, 0.5, h);
  solution.extend(0.5);
  double error = 0;
  for (int i = 1; i < 32; ++i) error = std::max(error, error_at(solution, 0.5 + h * i / 32));
  return error;
}

double observed_order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(RungeKutta, StepsHaveTheirOrder) {
  EXPECT_NEAR(observed_order(global_error(dop853, 0.25), global_error(dop853, 0.125)), 8, 0.7);
  for (const RungeKutta* method : {&tsit5, &cash_karp})
    EXPECT_NEAR(observed_order(global_error(*method, 0.03125), global_error(*method, 0.015625)), 5,
                0.3)
        << method->name;
}

// local errors: one order more
TEST(RungeKutta, PolynomialsHaveTheirOrder) {
  EXPECT_NEAR(observed_order(inner_error(dop853, 0.25), inner_error(dop853, 0.125)), 8, 0.7);
  for (const RungeKutta* method : {&tsit5, &cash_karp})
    EXPECT_NEAR(observed_order(inner_error(*method, 0.03125), inner_error(*method, 0.015625)), 5,
                0.3)
        << method->name;
}

// Rows of a sum to c; b, and the polynomial's weights, integrate constants.
TEST(RungeKutta, TablesAreConsistent) {
  for (const RungeKutta* method : {&dop853, &tsit5, &cash_karp}) {
    ASSERT_EQ(method->c.size(), static_cast<std::size_t>(method->all_stages()));
    ASSERT_EQ(method->a.size(),
              static_cast<std::size_t>(method->all_stages() * (method->all_stages() - 1) / 2));
    const auto sum = [](std::span<const double> row) {
      double total = 0;
      for (const double x : row) total += x;
      return total;
    };
    for (int i = 1; i < method->all_stages(); ++i)
      EXPECT_NEAR(sum(method->row(i)), method->c[static_cast<std::size_t>(i)], 2e-14)
          << method->name << " row " << i;
    for (int i = 0; i < method->error_rows(); ++i)
      EXPECT_NEAR(sum(method->error_row(i)), 0, 1e-14) << method->name;
    for (int i = 0; i < method->dense_rows(); ++i)
      EXPECT_NEAR(sum(method->dense_row(i)), 0, 1e-12) << method->name;
  }
}

// One period of an ellipse of eccentricity 0.5: errors follow tolerances over six decades.
class Kepler final : public Equations {
 public:
  explicit Kepler(double allowed) : allowed_(allowed) {}
  int size() const override { return 4; }
  void slope(double, const double* y, const double*, double* to) const override {
    const double r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * std::sqrt(r2);
    to[0] = y[2];
    to[1] = y[3];
    to[2] = -y[0] / r3;
    to[3] = -y[1] / r3;
  }
  void tolerances(const double*, const double*, double* allowed) const override {
    std::fill(allowed, allowed + 4, allowed_);
  }
  double longest_step(const double*, const double*, const double*) const override { return 10; }
  static std::vector<double> start() { return {0.5, 0, 0, std::sqrt(3.0)}; }

 private:
  double allowed_;
};

TEST(Solution, ErrorsFollowWhatIsAllowed) {
  for (const RungeKutta* method : {&dop853, &tsit5, &cash_karp}) {
    double before = 1;
    for (double allowed = 1e-4; allowed > 1e-11; allowed *= 0.1) {
      Solution solution(*method, std::make_unique<Kepler>(allowed), 0, Kepler::start());
      const double period = 2 * std::numbers::pi;
      ASSERT_TRUE(solution.extend(period));
      double error = 0;
      for (int i = 0; i < 4; ++i)
        error = std::max(error, std::abs(solution.at(period).value(i, period) -
                                         Kepler::start()[static_cast<std::size_t>(i)]));
      EXPECT_LT(error, 400 * allowed) << method->name << " " << allowed;
      EXPECT_LT(error, before) << method->name << " " << allowed;
      before = error;
      EXPECT_LT(solution.counts().rejected, solution.counts().steps / 3 + 4) << method->name;
    }
  }
}

TEST(Solution, DoesNotDependOnWhoAsks) {
  Solution at_once(dop853, std::make_unique<Kepler>(1e-9), 0, Kepler::start());
  Solution piecewise(dop853, std::make_unique<Kepler>(1e-9), 0, Kepler::start());
  at_once.extend(20);
  for (double t = 0; t < 20; t += 0.37) {
    piecewise.extend(t);
    piecewise.at(t).value(0, t);
  }
  for (double t = 19.9; t > 0; t -= 0.11)
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(at_once.at(t).value(i, t), piecewise.at(t).value(i, t)) << t;
}

TEST(Solution, RatesAreThoseOfThePolynomialAndContinuous) {
  Solution solution(dop853, std::make_unique<Kepler>(1e-8), 0, Kepler::start());
  solution.extend(6);
  for (double t = 0.01; t < 6; t += 0.1) {
    const DenseStep& step = solution.at(t);
    const double d = 1e-5;
    if (t - d < step.start() || t + d > step.end()) continue;
    EXPECT_NEAR(step.rate(0, t), (step.value(0, t + d) - step.value(0, t - d)) / (2 * d), 1e-8);
    EXPECT_NEAR(step.vector_rate(0, t).x(), step.rate(0, t), 1e-14);
  }
  const double joint = solution.at(1).end();
  const DenseStep &left = solution.at(1), &right = solution.at(joint);
  ASSERT_EQ(right.start(), joint);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(left.value(i, joint), right.value(i, joint), 1e-14);
    EXPECT_NEAR(left.rate(i, joint), right.rate(i, joint), 1e-12);
  }
}

// Between the control points of any part of a step lies all that it does there.
TEST(Solution, ControlPointsBoundTheirPart) {
  Solution solution(dop853, std::make_unique<Kepler>(1e-6), 0, Kepler::start());
  solution.extend(1);
  const DenseStep& step = solution.at(1);
  const double length = step.end() - step.start();
  for (const auto& [r0, r1] :
       {std::pair{0.0, 1.0}, {0.2, 0.3}, {0.6, 1.0}, {0.0, 0.1}, {0.3, 0.3 + 1e-9}}) {
    const double from = step.start() + r0 * length, to = step.start() + r1 * length;
    for (int order = 0; order < 2; ++order) {
      DenseStep::Control points;
      step.control(order, 0, from, to, points);
      const int last = step.degree() - order;
      Vec3 lo = points[0], hi = points[0];
      for (int j = 1; j <= last; ++j) {
        lo = lo.cwiseMin(points[j]);
        hi = hi.cwiseMax(points[j]);
      }
      const auto exact = [&](double t) {
        return order == 0 ? step.vector(0, t) : step.vector_rate(0, t);
      };
      EXPECT_LT((points[0] - exact(from)).norm(), 1e-12);
      EXPECT_LT((points[last] - exact(to)).norm(), 1e-12);
      for (int i = 0; i <= 50; ++i) {
        const Vec3 y = exact(from + (to - from) * i / 50);
        EXPECT_TRUE((y.array() >= lo.array() - 1e-12).all() &&
                    (y.array() <= hi.array() + 1e-12).all());
      }
      // and not far around it
      EXPECT_LT((hi - lo).norm(), 1.5 * (exact(to) - exact(from)).norm() + 0.02);
    }
  }
}

class Runaway final : public Equations {
 public:
  int size() const override { return 1; }
  void slope(double, const double* y, const double*, double* to) const override {
    *to = *y * *y;  // y = 1/(1-t)
  }
  void tolerances(const double*, const double*, double* allowed) const override { *allowed = 1e-6; }
  double longest_step(const double*, const double*, const double*) const override { return 1; }
};

TEST(Solution, StopsWhereItRunsAway) {
  for (const RungeKutta* method : {&dop853, &tsit5, &cash_karp}) {
    Solution solution(*method, std::make_unique<Runaway>(), 0, {1});
    EXPECT_TRUE(solution.extend(0.5));
    EXPECT_FALSE(solution.extend(1.5)) << method->name;
    ASSERT_TRUE(solution.failure());
    EXPECT_NEAR(solution.reached(), 1, 1e-3);
  }
}

// What stands still, and what moves evenly, is followed in the longest steps.
TEST(Solution, TakesTheLongestStepsWhereNothingHappens) {
  class Still final : public Equations {
   public:
    explicit Still(double rate) : rate_(rate) {}
    int size() const override { return 1; }
    void slope(double, const double*, const double*, double* to) const override { *to = rate_; }
    void tolerances(const double*, const double*, double* allowed) const override {
      *allowed = 1e-6;
    }
    double longest_step(const double*, const double*, const double*) const override { return 2; }

   private:
    double rate_;
  };
  for (const double rate : {0.0, 1e6}) {
    Solution solution(dop853, std::make_unique<Still>(rate), 0, {0});
    solution.extend(99);
    EXPECT_EQ(solution.counts().steps, 50u);
    EXPECT_NEAR(solution.at(99).value(0, 99), 99 * rate, 1e-14 * 99 * rate);
  }
}

}  // namespace
}  // namespace tw
