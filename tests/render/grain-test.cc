// The grain has no seam and no bias.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/grain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace tw::test {
namespace {

int value_at(const std::vector<std::uint8_t>& grain, int column, int row) {
  return grain[static_cast<std::size_t>(4 * (row * grain_side + column))];
}

TEST(Grain, it_goes_on_over_its_edges_as_it_does_inside) {
  const auto grain = make_grain();
  double inside = 0, edges = 0;
  for (int i = 0; i < grain_side; ++i) {
    inside += std::abs(value_at(grain, 100, i) - value_at(grain, 101, i));
    edges += std::abs(value_at(grain, grain_side - 1, i) - value_at(grain, 0, i));
  }
  EXPECT_LT(edges, 2 * inside);
  EXPECT_GT(edges, 0);
}

TEST(Grain, it_is_neither_lighter_nor_darker_on_the_whole) {
  const auto grain = make_grain();
  ASSERT_EQ(grain.size(), 4u * grain_side * grain_side);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < grain.size(); i += 4) {
    sum += grain[i] - 128.0;
    squares += (grain[i] - 128.0) * (grain[i] - 128.0);
  }
  const double count = grain_side * grain_side;
  EXPECT_NEAR(sum / count, 0, 4);
  EXPECT_GT(std::sqrt(squares / count), 15);
}

}  // namespace
}  // namespace tw::test
