// Root finding to full convergence.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "math/root.h"
#include "math/maximum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "base/random.h"

namespace tw::test {
namespace {

// Opposite signs at the ends, which are neighbours or nearly so; or the exact root.
void expect_narrow(const Bracket& b, const std::function<double(double)>& f) {
  EXPECT_LE(b.left, b.right);
  EXPECT_EQ(b.f_left, f(b.left));
  EXPECT_EQ(b.f_right, f(b.right));
  if (b.f_left != 0 && b.f_right != 0) {
    EXPECT_LT(b.f_left * b.f_right, 0);
    const double ulp = std::max(std::abs(b.left), std::abs(b.right)) * 0x1p-52;
    EXPECT_LE(b.right - b.left, 2 * ulp);
  }
}

TEST(Root, is_bracketed_to_neighbouring_numbers) {
  const std::function<double(double)> functions[] = {
      [](double x) { return x * x - 2; },
      [](double x) { return std::cos(x) - x; },
      [](double x) { return std::exp(x) - 3; },
      [](double x) { return x * x * x - 1e-3; },
      [](double x) { return std::atan(50 * (x - 0.3)); },
      [](double x) { return x < 1.1 ? -1.0 : 1.0; },  // a step
      [](double x) { return std::copysign(std::sqrt(std::abs(x - 0.7)), x - 0.7); },
  };
  for (const auto& f : functions) {
    int calls = 0;
    const auto counted = [&](double x) {
      ++calls;
      return f(x);
    };
    expect_narrow(find_root(counted, 0.0, 2.0, f(0), f(2)), f);
    EXPECT_LE(calls, 120);
  }
}

TEST(Root, of_smooth_functions_takes_few_calls) {
  int calls = 0;
  const auto f = [&](double x) {
    ++calls;
    return x * x - 2;
  };
  const Bracket b = find_root(f, 1.0, 2.0, -1.0, 2.0);
  EXPECT_NEAR(b.left, std::sqrt(2.0), 1e-15);
  EXPECT_LE(calls, 12);
}

// Near its root it is one of two numbers, as a distance that is found in two ways.
TEST(Root, of_what_is_rounded_is_on_the_side_of_the_left_end) {
  for (int i = 0; i < 1000; ++i) {
    const double root = 1e-3 * (i + 0.5), slope = i % 2 == 0 ? -3 : 3;
    int calls = 0;
    const auto f = [&](double x) {
      ++calls;
      const double exact = slope * (x - root);
      return std::abs(exact) > 1e-15 ? exact : exact > 0 ? 2e-15 : -4e-16;
    };
    const double left = f(0), right = f(1);
    calls = 0;
    const Bracket b = find_root(f, 0, 1, left, right, 3e-15);
    EXPECT_LT(std::abs(b.left - root), 1e-14);
    EXPECT_EQ(b.f_left > 0, left > 0);
    EXPECT_LE(calls, 4);
  }
}

TEST(Root, random_cubics_are_bracketed_in_either_direction) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double root = random.real(-1, 1), b = random.real(-2, 2);
    const double c = b * b / 4 + random.real(0.01, 2), sign = random.below(2) ? 1 : -1;
    const auto f = [&](double x) { return sign * (x - root) * (x * x + b * x + c); };
    const double left = root - random.real(0, 3), right = root + random.real(0, 3);
    const Bracket found = find_root(f, left, right, f(left), f(right));
    expect_narrow(found, f);
    EXPECT_NEAR(found.left, root, 1e-13);
  }
}

TEST(Root, zero_at_an_end_is_the_root) {
  const auto f = [](double x) { return x - 1; };
  const Bracket at_left = find_root(f, 1.0, 2.0, 0.0, 1.0);
  EXPECT_EQ(at_left.left, 1);
  const Bracket at_right = find_root(f, 0.0, 1.0, -1.0, 0.0);
  EXPECT_EQ(at_right.right, 1);
}

TEST(Maximum, is_found_inside_and_at_the_ends) {
  const auto top_at = [](double place) {
    return [place](double x) { return -std::abs(x - place) + 0.1 * std::min(x, place); };
  };
  for (const double place : {-1.0, -0.2, 0.7, 2.0, 5.0})
    EXPECT_NEAR(greatest_at(top_at(place), -1, 2, 1e-9), std::min(place, 2.0), 1e-9);
}

}  // namespace
}  // namespace tw::test
